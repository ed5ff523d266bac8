"""Faults of data from outside: keys and values of any kind, names and texts, XML."""

from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, EDIT_TASK, Remedy

RETYPE = Remedy("retype", "", "Write a plain name")


# fmt: off
# keys and values
class UnknownKey(Reason, text="unknown key", action=EDIT_CONFIG): pass
class MissingKey(Reason, text="is missing", action=EDIT_CONFIG): pass
class BadSetting(Reason, text="{problem}", action=EDIT_CONFIG): problem: Reason
class BadValueOf(Reason, text="{problem}, but it is {value}", action=EDIT_CONFIG): problem: Reason; value: str
class KeyProblem(Reason, text="{key}: {problem}"): key: str; problem: Reason
class MoreProblems(Reason, text="{problem} (and {more} more)"): problem: Reason; more: int
class MustBeNumber(Reason, text="must be a number"): pass
class MustBeFinite(Reason, text="must be a finite number"): pass
class MustBeWhole(Reason, text="must be a whole number"): pass
class MustBeTrueOrFalse(Reason, text="must be true or false"): pass
class MustBeText(Reason, text="must be a text"): pass
class MustBeList(Reason, text="must be a list"): pass
class MustBeKeys(Reason, text="must be an object: keys with values"): pass
class MustBeAbove(Reason, text="must be greater than {limit}"): limit: str
class MustBeAtLeast(Reason, text="must be at least {limit}"): limit: str
class MustBeBelow(Reason, text="must be less than {limit}"): limit: str
class MustBeAtMost(Reason, text="must be at most {limit}"): limit: str
class MustBeOneOf(Reason, text="must be one of {choices}"): choices: str
class MustFitPattern(Reason, text="does not fit the pattern {pattern}"): pattern: str

# names and texts
class BadText(Reason, text="{field} {value} {problem}"): field: str; value: str; problem: Reason
class BadName(Reason, text="{value} {problem}", action=RETYPE): value: str; problem: Reason
class EmptyName(Reason, text="is empty", action=RETYPE): pass
class ControlLetter(Reason, text="holds the control character {letter}", action=RETYPE): letter: str
class HiddenLetter(Reason, text="holds an invisible character", action=RETYPE): pass
class OuterBlank(Reason, text="begins or ends with a blank", action=RETYPE): pass
class LongName(Reason, text="has more than {limit} letters", action=RETYPE): limit: int

# XML
class TaskTooLarge(Reason, text="the task is larger than {limit} bytes"): limit: int
class TextNotUtf8(Reason, text="the text is not UTF-8"): pass
class NulByte(Reason, text="the text contains a NUL byte"): pass
class TaskEmpty(Reason, text="the task is empty"): pass
class ManyTags(Reason, text="the text has more than {limit} tags"): limit: int
class ManyAttributes(Reason, text="an element has too many attributes"): pass
class NotUnicodeCharacter(Reason, text="a character is no valid Unicode"): pass
class HasDoctype(Reason, text="a task must not have a DOCTYPE (DTD) or entities"): pass
class WordTooLong(Reason, text="a name or a value is too long"): pass
class NotWellFormed(Reason, text="not well-formed XML ({problem})"): problem: str
class ElementsTooDeep(Reason, text="the elements are nested deeper than {limit}"): limit: int
class RightFile(Reason, text="a task file has some 10 to 100 kB: is this the right one?"): pass
class SaveAsUtf8(Reason, text="save the file as UTF-8"): pass
class SaveFromGroot(Reason, text="save it again from Groot"): pass
class ExportFromGroot(Reason, text="export it from Groot; it begins with <root main_tree_to_execute=\"...\">"): pass
class RemoveThem(Reason, text="remove them"): pass
class CorrectThere(Reason, text="correct it there"): pass
class SplitTask(Reason, text="split the task into subtrees"): pass
class TemplateOuter(Reason, text="the outermost element of a template is <root>, here it is <{tag}>"): tag: str
class TemplateTrees(Reason, text="a template has exactly one <BehaviorTree>, here are {count}"): count: int
class TemplateNodes(Reason, text="the tree of a template has exactly one node at its top, here are {count}"): count: int
class TemplateVersion(Reason, text="a template has the form of BehaviorTree.CPP v3, as Groot 1 writes it"): pass
class TemplateInclude(Reason, text="a template includes no other file"): pass
class XmlLine(Reason, text="line {line}: {what}", action=EDIT_TASK): line: int; what: Reason
class XmlHint(Reason, text="{what}: {hint}"): what: Reason; hint: Reason
# fmt: on
