// What the page of work shows of a day.
import type { WorkSum } from "../models";

/** The day some days later, as 2026-11-27. */
export function dayBeside(day: string, days: number): string {
  const then = new Date(`${day}T12:00:00Z`);
  then.setUTCDate(then.getUTCDate() + days);
  return then.toISOString().slice(0, 10);
}

/** The hours, and how much of the best one each has dug. */
export function hoursOf(hours: WorkSum[]): { one: WorkSum; share: number }[] {
  const most = Math.max(...hours.map((one) => one.bank), 0);
  return hours.map((one) => ({ one, share: most > 0 ? one.bank / most : 0 }));
}

/** What took how much of all the time, the longest first. */
export function partsOf(parts: Record<string, number>): { name: string; minutes: number; share: number }[] {
  const all = Object.values(parts).reduce((sum, one) => sum + one, 0);
  return Object.entries(parts)
    .sort(([, one], [, other]) => other - one)
    .map(([name, seconds]) => ({ name, minutes: seconds / 60, share: all > 0 ? seconds / all : 0 }));
}
