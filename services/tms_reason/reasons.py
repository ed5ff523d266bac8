"""Faults of data from outside: keys and values of any kind, names and texts."""

from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, Remedy

RETYPE = Remedy("retype", "", "Write a plain name")


# fmt: off
# keys and values
class UnknownKey(Reason, text="unknown key", action=EDIT_CONFIG): pass
class MissingKey(Reason, text="is missing", action=EDIT_CONFIG): pass
class BadSetting(Reason, text="{problem}", action=EDIT_CONFIG): problem: Reason
class BadValueOf(Reason, text="{problem}, but it is {value}", action=EDIT_CONFIG): problem: Reason; value: str

# names and texts
class BadText(Reason, text="{field} {value} {problem}"): field: str; value: str; problem: Reason
class BadName(Reason, text="{value} {problem}", action=RETYPE): value: str; problem: Reason
class EmptyName(Reason, text="is empty", action=RETYPE): pass
class ControlLetter(Reason, text="holds the control character {letter}", action=RETYPE): letter: str
class HiddenLetter(Reason, text="holds a character that nobody sees", action=RETYPE): pass
class OuterBlank(Reason, text="begins or ends with a blank", action=RETYPE): pass
class LongName(Reason, text="has more than {limit} letters", action=RETYPE): limit: int
# fmt: on
