"""What is wrong with a tree, what its author should know, and what its nodes say while they run."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_TASK, TEMPLATES


# fmt: off
# where, and what to do
class Line(Reason, text="line {line}"): line: int
class LineAt(Line, text="line {line}, at {path}"): path: str
class FileLine(Line, text="{file}, line {line}"): file: str
class FileLineAt(Line, text="{file}, line {line}, at {path}"): path: str; file: str
class InFile(Reason, text="{file}"): file: str
class AtNode(Reason, text="at {path}"): path: str
class InTemplate(Reason, text="in template {place}: {what}"): place: str; what: Reason
class Placed(Reason, text="{place}: {what}", action=EDIT_TASK): place: Reason; what: Reason
class Hinted(Reason, text="{what} ({hint})"): what: Reason; hint: Reason
class DidYouMean(Reason, text="did you mean '{name}'?"): name: str
class There(Reason, text="there is {names}"): names: tuple[str, ...]
class ThereIsNoTree(Reason, text="there is no tree"): pass
class OneOf(Reason, text="one of {names}"): names: tuple[str, ...]
class ItsPorts(Reason, text="its ports are: {ports}"): ports: tuple[str, ...]
class NoPorts(Reason, text="it has no ports"): pass
class WriteSubTree(Reason, text="write <SubTree ID=\"{tree}\"/>"): tree: str
class AddPort(Reason, text="add {port}=... to line {line}"): port: str; line: int
class AddThirdChild(Reason, text="add a third child"): pass
class UsePath(Reason, text="use a path"): pass
class OnlyV3(Reason, text="this engine runs v3 trees, as Groot 1 writes them"): pass
class KeyHasNoValue(Reason, text="the key '{key}' has no value that fits"): key: str
class DoesNotFit(Reason, text="'{value}' does not fit"): value: str
class KeysKeepTypes(Reason, text="once declared, the type of a key does not change"): pass
class ChooseGrootFile(Reason, text="a tree begins with <root ...>: choose a file that Groot saved"): pass
class TaskFilesAreSmall(Reason, text="a task file has some 10 to 100 kB"): pass
class NoTerminal(Reason, text="it asks on a terminal, and this engine has none"): pass
class OldSpelling(Reason, text="did you mean '{name}'? (the old spelling is not registered in v3.8)"): name: str

# documents
class NoFile(Reason, text="there is no file {file}"): file: str
class FileTooLarge(Reason, text="{file} is larger than {limit} bytes"): file: str; limit: int
class NotXml(Reason, text="this is not XML"): pass
class NotRoot(Reason, text="the outermost element must be <root>, it is <{tag}>"): tag: str
class NestedTooDeep(Reason, text="the elements are nested deeper than {limit}"): limit: int
class NoMainTree(Reason, text="main_tree_to_execute is not given"): pass
class NoBehaviorTree(Reason, text="there is no <BehaviorTree> in it"): pass
class UnknownMainTree(Reason, text="main_tree_to_execute names an unknown tree '{tree}'"): tree: str
class TwoTrees(Reason, text="there are two trees '{tree}'; the first one is used"): tree: str
class TwoPalettes(Reason, text="there is more than one <TreeNodesModel>"): pass
class IncludeRosPkg(Reason, text="include with ros_pkg is not supported"): pass
class IncludeNeedsPath(Reason, text="include needs a path"): pass
class IncludeNoFolder(Reason, text="cannot include '{name}': this tree comes from no folder"): name: str
class IncludeOutside(Reason, text="include '{name}' is outside the tree's folder"): name: str
class IncludeCircle(Reason, text="include '{name}' includes itself"): name: str
class ManyIncludes(Reason, text="more than {limit} files are included"): limit: int
class CannotInclude(Reason, text="cannot include '{name}': {why}"): name: str; why: Reason

# templates: trees that ExecuteSubtask calls by name
class NoTemplate(Reason, text="there is no template '{template}'", action=TEMPLATES): template: str
class NoTemplateName(Reason, text="ExecuteSubtask needs 'subtask_name'"): pass
class TemplateUnusable(Reason, text="template '{template}' cannot be used: {why}"): template: str; why: Reason
class TemplateInItself(Reason, text="the template '{template}' calls itself ({chain})"): template: str; chain: str
class TemplatesNested(Reason, text="more than {limit} templates call each other"): limit: int
class TemplatesLarge(Reason, text="the templates of the task have more than {limit} nodes"): limit: int
class CallWithChildren(Reason, text="ExecuteSubtask has no children"): pass
class CallInV4(Reason, text="ExecuteSubtask is for documents of BehaviorTree.CPP v3"): pass
class KeyOpen(Reason, text="${key}$ has no value"): key: str
class KeysGiven(Reason, text="the call gives {keys}; {key}:none says that there is none"):
    keys: tuple[str, ...]; key: str
class NoKeysGiven(Reason, text="the call gives no values; {key}:none says that there is none"): key: str
class ValueTooLong(Reason, text="the value of {port} has more than {limit} letters"): port: str; limit: int
class TemplateUnseen(Reason, text="template '{template}' is not looked into, as no database answers"): template: str
class KeyBecomesNone(Reason, text="${key}$ has no value; the C++ system writes the word none"): key: str
class NestedCall(Reason, text="a template calls template '{template}'; the C++ system cannot load that"): template: str
class CallNotSeen(Reason, text="the C++ system does not see this call: "
    "it must be written <Action ID=\"ExecuteSubtask\" ...>, ID first"): pass
class CallWithSlash(Reason, text="the C++ system does not see this call, for {port}='{value}' has a /"):
    port: str; value: str
class PartWithoutColon(Reason, text="subtask_parameters: '{part}' has no colon and is left out"): part: str
class TreeNameForCpp(Reason, text="the C++ system needs main_tree_to_execute=\"BehaviorTree\", <BehaviorTree "
    "ID=\"BehaviorTree\"> and a <TreeNodesModel> after it"): pass

# trees and nodes of a document
class OneChildInTree(Reason, text="a BehaviorTree must have exactly one child, it has {count}"): count: int
class NotUsed(Reason, text="the tree '{tree}' is not used, and could not be used: {why}"): tree: str; why: Reason
class InSubTreePlus(Reason, text="what is inside a SubTreePlus is ignored, and could not be used: {why}"): why: Reason
class NeedsId(Reason, text="<{tag}> needs an ID"): tag: str
class SubTreeWithChildren(Reason, text="a SubTree has no children"): pass
class OneChildInDecorator(Reason, text="the decorator {node} must have exactly one child, it has {count}"):
    node: str; count: int
class LeafWithChildren(Reason, text="{node} has no children"): node: str
class NeedsChildren(Reason, text="{node} needs at least one child"): node: str
class ThreeChildrenInV4(Reason, text="WhileDoElse with 2 children is a feature of BehaviorTree.CPP v4"): pass
class IfThenElseChildren(Reason, text="IfThenElse must have 2 or 3 children, it has {count}"): count: int
class WhileDoElseChildren(Reason, text="WhileDoElse must have 3 children, it has {count}"): count: int
class SwitchChildren(Reason, text="{node} must have {wanted} children (the last one is the default), it has {count}"):
    node: str; wanted: int; count: int
class NoTreeOfId(Reason, text="there is no tree '{tree}'"): tree: str
class TreeNotNode(Reason, text="<{tag}> is a tree, not a node"): tag: str
class NoNode(Reason, text="there is no node '{node}'"): node: str
class NoPort(Reason, text="{node} has no port '{port}', possibly a typo"): node: str; port: str
class PortMissing(Reason, text="{node} needs '{port}'"): node: str; port: str
class V4Node(Reason, text="<{node}> is a node of BehaviorTree.CPP v4"): node: str
class V4Script(Reason, text="the script attribute '{key}' is a feature of BehaviorTree.CPP v4"): key: str
class V4RootBlackboard(Reason, text="{key}='{value}': the root blackboard is a feature of BehaviorTree.CPP v4"):
    key: str; value: str
class V4Json(Reason, text="{key}='{value}': json values are a feature of BehaviorTree.CPP v4"): key: str; value: str
class V4SharedBlackboard(Reason, text="__shared_blackboard does not exist in a document of BehaviorTree.CPP v4"): pass
class TreeInItself(Reason, text="the tree '{tree}' contains itself ({chain})"): tree: str; chain: str
class ManyNodes(Reason, text="the tree has more than {limit} nodes"): limit: int
class TreeTooDeep(Reason, text="the tree is deeper than {limit} nodes"): limit: int
class AdoptedLeaf(Reason, text="{node} is not known here; its entry in TreeNodesModel says that it is a leaf node"):
    node: str
class NotTrueOrFalse(Reason, text="{key}='{value}' is not true or false"): key: str; value: str

# what its author should know
class ThrowsWithoutPort(Reason, text="{node} needs '{port}', it throws when ticked"): node: str; port: str
class PortType(Reason, text="{port}='{value}' of {node} is not of type {type}"):
    port: str; value: str; node: str; type: str
class MayHang(Reason, text="{node} is endless and what is in it can complete at once: "
    "the C++ system can hang here; this engine goes on at the next tick"): node: str
class KeyChangesType(Reason, text="the key '{key}' changes its type; the C++ system throws here"): key: str
class KeyOfTwoTypes(Reason, text="the key '{key}' is written as {type} in line {line} and as {other} here; "
    "the C++ system throws here, this engine changes its type"): key: str; type: str; line: int; other: str
class TextAsBoolean(Reason, text="{key} holds the text '{value}', taken as a boolean; the C++ system throws here"):
    key: str; value: str
class StoredTextThrows(Reason, text="SetBlackboard stores the text '{value}' in '{key}': the C++ system throws here, "
    "this engine takes true and false as booleans (SetLocalBlackboard stores them as such)"): value: str; key: str
class StoredTextFails(Reason, text="SetBlackboard stores the text '{value}' in '{key}': "
    "the C++ system fails here, this engine takes it as a boolean"): value: str; key: str
class NumberNotText(Reason, text="{key} holds a number, not a text; "
    "the C++ system throws here if nothing else declares it"): key: str
class KeyIsNumber(Reason, text="{key} is a number; the C++ system does not know it in {node}"): key: str; node: str
class TextCountsAsBoolean(Reason, text="the text '{value}' of '{key}' counts as a boolean; "
    "the C++ system does not know the key here"): value: str; key: str
class TextCountsHere(Reason, text="the text '{value}' counts as a boolean or a number here; "
    "the C++ system calls the expression invalid"): value: str
class NeverWritten(Reason, text="nothing in the task gives the key '{key}' a value, so {node} fails; "
    "the C++ system may throw here"): key: str; node: str
class NumberBesideText(Reason, text="{key} is a number and is compared with the text '{value}': "
    "the C++ system calls the expression invalid, this engine compares the numbers"): key: str; value: str
class OneRoundMore(Reason, text="{key} has no value before this loop: "
    "version 6 of the C++ system runs the child once more after it is true"): key: str
class BeginningWritten(Reason, text="of '{value}' only the number at its beginning, {number}, is written; "
    "in quotes it is a text"): value: str; number: str
class WholeWritten(Reason,
    text="version 6 of the C++ system writes {number} for '{value}'; input_type='double' keeps it"):
    value: str; number: str
class AllBraces(Reason, text="{port}='{value}' begins and ends with a brace: "
    "the C++ system takes all of it for one key and throws here"): port: str; value: str
class NameMissing(Reason, text="{node} has nothing in '{port}'"): node: str; port: str
class NumberTooBig(Reason, text="{key} is too big for 32 bits; "
    "the C++ system does not put such a number into an expression"): key: str
class AlwaysFails(Reason, text="{why}, so {node} always fails"): why: Reason; node: str
class NoRosName(Reason, text="{port}='{name}' can be no ROS name"): port: str; name: str

# nodes that cannot go on
class MissingParameter(Reason, text="{node}: missing parameter '{port}'"): node: str; port: str
class OutputNotConnected(Reason, text="{node}: the output '{port}' is not connected"): node: str; port: str
class KeyOfAnotherType(Reason, text="the key '{key}' is of type {type} already and is used here as {other}"):
    key: str; type: str; other: str
class UseAnotherKey(Reason, text="use another key, or the same type at both ports"): pass
class KeyCannotBecome(Reason, text="the key '{key}' is of type {type} and cannot become {other}"):
    key: str; type: str; other: str
class TextDoesNotFitKey(Reason, text="the text '{value}' does not fit the key '{key}', which is {type}"):
    value: str; key: str; type: str
class ChildIdle(Reason, text="{node}: the child '{child}' must never return IDLE"): node: str; child: str
class SyncRunning(Reason, text="{node}: a synchronous action must not return RUNNING"): node: str
class ActionIdle(Reason, text="{node}: an action must not return IDLE"): node: str
class FewChildren(Reason,
    text="Parallel: {count} children are fewer than the threshold {threshold}, it can never {end}"):
    count: int; threshold: int; end: Reason
class Succeed(Reason, text="succeed"): pass
class Fail(Reason, text="fail"): pass
class KeyNotBoolean(Reason, text="KeepRunningUntilFlgup: {key} is '{value}', not true or false"): key: str; value: str
class NoMachines(Reason, text="{node}: this tree was loaded without machines"): node: str
class PyTreesBlackboard(Reason, text="{node}: the blackboard of py_trees is not for use here"): node: str
class UsePorts(Reason, text="use ports: all runs share that blackboard"): pass
class NoWorld(Reason, text="{node}: this tree was loaded without a world to ask"): node: str
class NodeError(Reason, text="{error}: {problem}"): error: str; problem: str  # an exception out of a node

# why a node waits or has failed
class LoopedInTick(Reason, text="looped {rounds} times in this tick, goes on in the next"): rounds: int
class Waits(Reason, text="waits {seconds}"): seconds: Seconds
class WaitsForWorkers(Reason, text="waits for a thread of its last start to end"): pass
class WaitsForAnswer(Reason, text="waits for an answer"): pass
class WaitsForOperator(Reason, text="waits for an operator: {question}"): question: str
class RunsUntil(Reason, text="runs until {key} is true"): key: str
class NoValue(Reason, text="{key} or {counter} has no value"): key: str; counter: str
class HoldsNoNumber(Reason, text="{key} holds no number"): key: str
class NoSuchType(Reason, text="input_type='{type}' is none of int, double, bool and string"): type: str
class NoOperation(Reason, text="operation='{operation}' is none of add, push, remove and reset"): operation: str
class UnevenLists(Reason, text="mongo_param_name has {names} parts and mongo_value {values}"): names: int; values: int
class NotPlain(Reason, text="{record}.{field} is not a plain value"): record: str; field: str
class Sending(Reason, text="sending"): pass
class Working(Reason, text="running"): pass

# expressions
class NoExpression(Reason, text="there is no expression"): pass
class ExpressionTooLong(Reason, text="the expression is too long"): pass
class ExpressionSigns(Reason, text="only names, numbers, == != < > <= >= and or ( ) are allowed"): pass
class NameBeginsWithDigit(Reason, text="a name begins with a digit"): pass
class ExpressionUnreadable(Reason, text="the expression cannot be read"): pass
class ConstantNoNumber(Reason, text="{value} is not a number"): value: str
class OnlyNumbersNegative(Reason, text="only numbers can be negative"): pass
class OnlyComparisons(Reason, text="only == != < > <= >= compare values"): pass
class TextCompared(Reason, text="the text '{value}' is compared with {other}"): value: str; other: str
class KeyWithoutValue(Reason, text="a key has no value yet"): pass
class NotBooleanKey(Reason, text="{key} is not a boolean key"): key: str
class FormulaUnreadable(Reason,
    text="the formula cannot be read: only numbers, keys in braces, + - * / ( ) are allowed"): pass
class DividesByZero(Reason, text="the formula divides by zero"): pass
class ResultTooLarge(Reason, text="the result is too large"): pass
class ExpressionInvalid(Reason, text="{problem}"): problem: str
