// @vitest-environment jsdom
import { configure, fireEvent, render, screen, waitFor } from "@testing-library/react";
import { afterEach, beforeEach, expect, test, vi } from "vitest";
import { Command } from "./command";
import { Confirm, confirmed } from "./confirm";
import { ended, listsChanged } from "./live";
import type { ReasonView, State } from "./models";
import { Said } from "./said";
import { filled } from "./server";
import { texts, timeOfDay } from "./texts";

configure({ asyncUtilTimeout: 60_000 }); // ms; a busy machine is no failure

beforeEach(async () => {
  await texts.changeLanguage("en");
  document.body.innerHTML = '<p id="message"></p>';
  document.body.dataset.role = "operator";
});
afterEach(() => vi.restoreAllMocks());

const REASON: ReasonView = {
  code: "X",
  args: {},
  text: { en: "it waits", ja: "待っています" },
  details: { en: "on /topic", ja: "トピック" },
  action: { name: "records", command: "tms param", args: {}, text: { en: "Correct it", ja: "直す" } },
};

test("a reason is said in the language of the page, with what helps", async () => {
  render(<Said reason={REASON} />);
  expect(screen.getByText("it waits")).toBeTruthy();
  expect(screen.getByRole("link", { name: "Correct it" }).getAttribute("href")).toBe("#data");
  await texts.changeLanguage("ja");
  expect(await screen.findByRole("link", { name: "直す" })).toBeTruthy();
});

const helpedBy = (name: string, args: Record<string, unknown>): ReasonView => ({
  ...REASON,
  action: { name, command: "tms it", args, text: { en: "Help", ja: "助ける" } },
});

test("what helps is a button, the page of the very process, or words, and never a command of a terminal", () => {
  const { rerender, container } = render(<Said reason={helpedBy("give_back", { machine: "zx200" })} />);
  expect(screen.getByRole("button", { name: "Help" })).toBeTruthy();
  rerender(<Said reason={helpedBy("logs", { process: "zx200:rc" })} />);
  expect(screen.getByRole("link", { name: "Help" }).getAttribute("href")).toBe("#system/zx200%3Arc");
  rerender(<Said reason={helpedBy("processes", {})} />);
  expect(screen.getByRole("link", { name: "Help" }).getAttribute("href")).toBe("#system");
  rerender(<Said reason={helpedBy("look", {})} />);
  expect(container.textContent).toContain("Help");
  expect(container.textContent).not.toContain("tms it");
});

test("who may only look has no button that the server would refuse", () => {
  document.body.dataset.role = "viewer";
  const { rerender } = render(<Said reason={helpedBy("rearm", { machine: "zx200" })} />);
  expect(screen.getByText("Help")).toBeTruthy();
  expect(screen.queryByRole("button")).toBeNull();
  rerender(<Command work={async () => ""}>Go</Command>);
  expect(screen.queryByRole("button")).toBeNull();
  rerender(
    <Command needs="viewer" work={async () => ""}>
      Go
    </Command>,
  );
  expect(screen.getByRole("button", { name: "Go" })).toBeTruthy();
});

test("a command is given once, until its answer comes", async () => {
  let answer = (_: string) => {};
  const work = vi.fn(() => new Promise<string>((done) => (answer = done)));
  render(<Command work={work}>Go</Command>);
  const button = screen.getByRole<HTMLButtonElement>("button", { name: "Go" });
  fireEvent.click(button);
  fireEvent.click(button);
  expect(work).toHaveBeenCalledTimes(1);
  answer("done");
  await waitFor(() => expect(button.disabled).toBe(false));
  expect(document.getElementById("message")?.textContent).toBe("done");
});

test("one answer does not count for two questions", async () => {
  HTMLDialogElement.prototype.showModal = vi.fn();
  render(<Confirm />);
  const first = confirmed("first?");
  expect(await confirmed("second?")).toBe(false);
  const dialog = document.getElementById("dialog") as HTMLDialogElement;
  dialog.returnValue = "yes";
  fireEvent(dialog, new Event("close"));
  expect(await first).toBe(true);
});

test("paths are filled in without a way out of them", () => {
  expect(filled("/api/runs/{run_id}/cancel", { run_id: "a/../b" })).toBe("/api/runs/a%2F..%2Fb/cancel");
});

test("lists are old when a run begins or ends, or the connection is back", () => {
  const state = (...ids: string[]) => ({ runs: ids.map((run_id) => ({ run_id, state: "running" })) }) as State;
  const live = (one: State | null, link: boolean | null = true) => ({ state: one, link });
  expect(listsChanged(live(state("a")), live(state("a")))).toBe(false);
  expect(listsChanged(live(state("a", "b")), live(state("a")))).toBe(true);
  expect(listsChanged(live(state("a")), live(state("a"), false))).toBe(true);
  expect(ended(state("b"), state("a", "b")).map((run) => run.run_id)).toEqual(["a"]);
});

test("a time of another day has its day", () => {
  const now = new Date(2026, 0, 31, 12, 0);
  expect(timeOfDay(new Date(2026, 0, 31, 9, 5).toISOString(), now.getTime())).toBe("09:05");
  expect(timeOfDay(new Date(2026, 0, 30, 9, 5).toISOString(), now.getTime())).toMatch(/30 Jan.* 09:05/);
});
