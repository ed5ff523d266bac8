// What ../../static has: what the pages share with the panel of one task.
declare module "old/words.js" {
  export const WORDS: Record<"ja" | "en", Record<string, string>>;
  export const PAGE_NAMES: string[];
}

declare module "old/strings.js" {
  export function translatePage(): void;
  export function switchLanguage(): void;
  export function onLanguage(listener: () => void): void;
}

declare module "old/dom.js" {
  export function say(text: string, bad?: boolean): void;
  export function mark(state: string): string;
  export function tone(state: string): "good" | "calm" | "bad";
  export function duration(seconds: number | null): string;
  export function confirmWith(question: (text: string) => Promise<boolean>): void;
}

declare module "old/server.js" {
  export function ask(path: string, body?: unknown): Promise<unknown>;
  export function watch(
    onState: (state: import("./models").State) => void,
    onLink: (there: boolean | null) => void,
  ): void;
  export function treeOf(run: string): import("./models").Tree | null;
  export function treeProblem(run: string): Error | null;
  export function siteNow(): number;
}

declare module "old/reasons.js" {
  export function sayError(error: unknown): void;
}

declare module "old/stop.js" {
  export function stop(machine?: string): Promise<void>;
  export function reportOpen(session: import("./models").Session): void;
}

declare module "old/actions.js" {
  export const COMMANDS: Record<string, (args: Record<string, unknown>) => Promise<string>>;
  export const LINKS: Record<string, (args: Record<string, unknown>) => string>;
  export function giveBack(name: string): Promise<string>;
  export function rearmMachine(name: string): Promise<string>;
  export function cancelRun(id: string): Promise<string>;
  export function restartProcess(name: string, running: number): Promise<string>;
}
