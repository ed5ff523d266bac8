import { expect, test } from "vitest";
import { add, copy, move, remove, setAttribute, step } from "./acts";
import { difference, differing, everyDifference } from "./difference";
import { begun, type Draft, edit, isChanged, redo, undo } from "./draft";
import { type EditNode, emptyTask, linesOf, treesOf, withTree } from "./groot";
import { groupsOf, typesOf } from "./palette";

const PALETTE = `<root><TreeNodesModel>
  <!-- ExecuteSubtask (version 6): A template. -->
  <Action ID="ExecuteSubtask"><input_port name="model_name"/><input_port name="subtask_name"/></Action>
  <!-- Inverter: Turn it round. -->
  <Decorator ID="Inverter" builtin="true"/>
  <!-- LeafNodeIc120 (version 5): Let ic120 do it. -->
  <Action ID="LeafNodeIc120"><input_port name="model_name" default="ic120"/><input_port name="subtask_name">what</input_port></Action>
  <!-- LeafNodeExcavator (version 6): Let it dig. -->
  <Action ID="LeafNodeExcavator"><input_port name="model_name"/><input_port name="primitive_name"/></Action>
  <!-- Sequence: One after another. -->
  <Control ID="Sequence" builtin="true"/>
  <!-- WaitForClick (versions 5 and 6): Ask. -->
  <Action ID="WaitForClick">
    <input_port name="window_title"/>
  </Action>
</TreeNodesModel></root>`;
const TYPES = typesOf(PALETTE);
const WAIT = '<Action ID="WaitForClick"/>';

const TREE = `<root main_tree_to_execute="M">
    <BehaviorTree ID="M">
        <Sequence>
            <Sequence name="a">
                <AlwaysSuccess name="a0"/>
                <AlwaysSuccess name="a1"/>
            </Sequence>
            <Inverter>
                <AlwaysSuccess name="i"/>
            </Inverter>
            <Sequence name="b"/>
            <AlwaysSuccess name="c"/>
        </Sequence>
    </BehaviorTree>
</root>
`;

const draft = (text = TREE): Draft => ({ text, tree: "M", chosen: "0" });
function treeOf(text: string) {
  const [tree] = treesOf(text, TYPES);
  if (tree === undefined) {
    throw new Error(text);
  }
  return tree;
}
const at = (text: string, path: string) => treeOf(text).nodes.get(path) as EditNode;
const shape = (node: EditNode): string => {
  const name = node.element.attributes.find((one) => one.name === "name")?.value ?? node.type;
  return node.children.length > 0 ? `${name}(${node.children.map(shape).join(" ")})` : name;
};
const shown = (text: string) => shape(at(text, "0"));

test("the palette has nodes with their help, and each machine's leaves", () => {
  expect(TYPES.get("WaitForClick")).toMatchObject({ kind: "action", builtin: false, help: "Ask." });
  expect(TYPES.get("LeafNodeIc120")?.ports[1]).toMatchObject({ name: "subtask_name", help: "what" });
  const workers = [
    { name: "ic120_1", model: "ic120", subtasks: ["st_ic120_go", "primitive_excavator_dig", "primitive_x_y"] },
  ];
  const groups = groupsOf(TYPES, workers, ["Other"], ["Dig"]);
  expect(groups.map((one) => one.title)).toEqual([
    "ed_controls",
    "ic120_1",
    "ed_decorators",
    "ed_others",
    "ed_subtrees",
    "templates",
  ]);
  expect(groups[1]?.entries.map((one) => one.source)).toEqual([
    '<Action ID="LeafNodeIc120" model_name="ic120_1" subtask_name="st_ic120_go"/>',
    '<Action ID="LeafNodeExcavator" model_name="ic120_1" primitive_name="primitive_excavator_dig"/>',
  ]);
  expect(groups[3]?.entries.map((one) => one.label)).toEqual(["WaitForClick"]);
  expect(groups[5]?.entries[0]?.source).toBe('<Action ID="ExecuteSubtask" subtask_name="Dig"/>');
});

test("a new node comes into, beside and around another, and Groot can read it", () => {
  const put = (path: string, where: "inside" | "before" | "after" | "around", source = WAIT) =>
    add(draft(), treeOf(TREE), at(TREE, path), where, source, TYPES);
  const inside = put("0.2", "inside");
  expect(inside?.chosen).toBe("0.2.0");
  expect(shown(inside?.text ?? "")).toBe("Sequence(a(a0 a1) Inverter(i) b(WaitForClick) c)");
  expect(inside?.text).toContain(`    <TreeNodesModel>
        <Action ID="WaitForClick">
          <input_port name="window_title"/>
        </Action>
    </TreeNodesModel>`);
  expect(shown(put("0.0", "before")?.text ?? "")).toBe("Sequence(WaitForClick a(a0 a1) Inverter(i) b c)");
  expect(put("0.3", "inside")?.chosen).toBe("0.4"); // a leaf holds none: behind it
  expect(shown(put("0.3", "around", "<Inverter/>")?.text ?? "")).toBe("Sequence(a(a0 a1) Inverter(i) b Inverter(c))");
  expect([put("0.1", "inside")?.chosen, put("0", "after"), put("0.3", "around")]).toEqual(["0.2", null, null]);
});

test("every move puts the node where it says, and chooses it there", () => {
  const tree = treeOf(TREE);
  let count = 0;
  for (const node of tree.nodes.values()) {
    for (const other of tree.nodes.values()) {
      for (const where of ["inside", "before", "after"] as const) {
        const next = move(draft(), tree, node, other, where);
        if (next?.text !== undefined && next.text !== TREE) {
          const then = at(next.text, next.chosen ?? "");
          expect([shape(then), node.path, other.path, where]).toEqual([shape(node), node.path, other.path, where]);
          expect(treeOf(next.text).nodes.size).toBe(tree.nodes.size);
          count += 1;
        }
      }
    }
  }
  expect(count).toBeGreaterThan(40);
});

test("a node moves step by step, where there is room", () => {
  const go = (path: string, way: "earlier" | "later" | "in" | "out") =>
    step(draft(), treeOf(TREE), at(TREE, path), way);
  expect(shown(go("0.0", "later")?.text ?? "")).toBe("Sequence(Inverter(i) a(a0 a1) b c)");
  expect(shown(go("0.3", "in")?.text ?? "")).toBe("Sequence(a(a0 a1) Inverter(i) b(c))");
  expect(shown(go("0.0.1", "out")?.text ?? "")).toBe("Sequence(a(a0) a1 Inverter(i) b c)");
  expect([go("0.0", "earlier"), go("0.2", "in"), go("0", "out")]).toEqual([null, null, null]);
});

test("a removed node leaves its neighbour chosen", () => {
  const gone = (path: string) => remove(draft(), treeOf(TREE), at(TREE, path))?.chosen;
  expect([gone("0.3"), gone("0.0"), gone("0.1.0"), gone("0")]).toEqual(["0.2", "0.0", "0.1", ""]);
  expect(copy(draft(), at(TREE, "0.1"))).toBe('<Inverter>\n    <AlwaysSuccess name="i"/>\n</Inverter>');
});

test("steps go back and forth, and know what is stored", () => {
  const one = edit(begun(TREE, "M", TREE), setAttribute(draft(), at(TREE, "0"), "name", "top") ?? {});
  expect([isChanged(one), isChanged(undo(one)), isChanged(redo(undo(one)))]).toEqual([true, false, true]);
  expect(edit(one, { chosen: "0.1" }).past).toHaveLength(1);
  expect(edit(undo(one), { text: "x" }).future).toEqual([]);
});

test("a new task and a new tree are drawn into", () => {
  const text = withTree(emptyTask("Dig & go"), "Second");
  expect(treesOf(text, TYPES).map((one) => one.id)).toEqual(["Dig & go", "Second"]);
  const next = add({ text, tree: "Second", chosen: "0" }, treeOf(text), at(text, "0"), "inside", WAIT, TYPES);
  expect([...linesOf(next?.text ?? "", treesOf(next?.text ?? "", TYPES)).keys()]).toEqual([5, 6, 10]);
});

test("the difference tells new, lost and changed nodes", () => {
  const now = TREE.replace('<AlwaysSuccess name="a0"/>', "<Wait/>").replace('name="c"', 'name="d"');
  const found = [...everyDifference(difference(at(TREE, "0"), at(now, "0")))];
  expect(
    found.filter((one) => one.change !== "same").map((one) => [one.change, one.node.label || one.node.type]),
  ).toEqual([
    ["removed", "a0"],
    ["added", "Wait"],
    ["changed", "d"],
  ]);
  expect(new Set(found.map((one) => one.path)).size).toBe(found.length);
  expect([...differing(difference(at(TREE, "0"), at(now, "0")))]).toEqual(["0", "0.0"]);
  expect(difference(at(TREE, "0"), null).map((one) => one.change)).toEqual(["removed"]);
});
