import { expect, test } from "vitest";
import { groupsOf } from "../finding_groups";
import type { Finding, ReasonView, Task } from "../models";
import { versionsOf } from "./versions";

test("findings of a kind are together, also where the kind is inside", () => {
  const finding = (line: number, code: string) =>
    ({ line, reason: { code: "AT", args: { line, why: { code, args: {} } } } as unknown as ReasonView }) as Finding;
  const found = [finding(1, "NO_RECORD"), finding(2, "NO_NODE"), finding(3, "NO_RECORD")];
  expect(groupsOf(found).map((group) => group.map((one) => one.line))).toEqual([[1, 3], [2]]);
});

test("tasks of one description are versions, the newest first", () => {
  const task = (id: number, description: string) => ({ id, description, model_name: "zx200" }) as Task;
  const groups = versionsOf([task(1, "dig"), task(2, ""), task(3, "dig"), task(4, ""), task(12, "dig")]);
  expect(groups.map((group) => group.map((one) => one.id))).toEqual([[12, 3, 1], [2], [4]]);
});
