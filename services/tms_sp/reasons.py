"""Reasons why a message changes no record, an input cannot be received, and values do not reach the database."""

from tms_reason.quantities import Moments, Number, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, PROCESSES, Remedy

SET_CLOCK = Remedy("set_clock", "", "Set the clock of the sensing PC")
NAME_FIELDS = Remedy("edit_config", "", "Name under `fields` what is wanted")


# fmt: off
# a message
class NamesNoRecord(Reason, text="the message names no record"): pass
class NothingAt(Reason, text="{path}: there is no {name}"): path: str; name: str
class NoElement(Reason, text="{path}: there is no such element among {count}"): path: str; count: int
class NoValueOf(Reason, text="{path} is a {kind}, not a number, text, true/false or an array of these"):
    path: str; kind: str
class WrongSize(Reason, text="{name} has {count} values, not {size}"): name: str; count: int; size: int
class SizesDiffer(Reason, text="the arrays have different lengths: {sizes}"): sizes: tuple[str, ...]
class NoValues(Reason, text="{names}: no values"): names: tuple[str, ...]
class ValueNotFinite(Reason, text="{name} is {value}"): name: str; value: str
class ValueTooLarge(Reason, text="{name} is {value}, the largest whole number is {limit}"):
    name: str; value: int; limit: int
class ValueOutOfRange(Reason, text="{name} is {value}, not from {low} to {high}"):
    name: str; value: Number; low: Number; high: Number
class StampNotFinite(Reason, text="its stamp is {value}"): value: str
class StampInFuture(Reason, text="its stamp lies {ahead} in the future", action=SET_CLOCK): ahead: Seconds
class MeasuredEarlier(Reason, text="it was measured {seconds} before the one that came earlier"): seconds: Moments
class ManyRecords(Reason, text="more than {limit} records: is {record} right?", action=EDIT_CONFIG):
    limit: int; record: str
class ManyWait(Reason, text="too many records wait for the database", action=PROCESSES): pass

class CloudFrame(Reason, text="its points are in the frame '{frame}', not in `map`"): frame: str
class CloudNotPoints(Reason, text="it is no cloud of points of the site: {problem}"): problem: str

# an input
class NoMessageField(Reason, text="the message has no field '{path}'; it has {fields}", action=EDIT_CONFIG):
    path: str; fields: tuple[str, ...]
class NoFieldInside(Reason, text="the message has no field '{path}': there is no '{name}' in a {kind}",
    action=EDIT_CONFIG): path: str; name: str; kind: str
class NoArray(Reason, text="{path}: {name} is a {kind}, no array", action=EDIT_CONFIG): path: str; name: str; kind: str
class NoNames(Reason, text="{path}: there is no array of texts called 'name' beside {name}; a number is needed",
    action=EDIT_CONFIG): path: str; name: str
class WrongKind(Reason, text="{path} is a {kind}, not {wanted}", action=EDIT_CONFIG):
    path: str; kind: str; wanted: Reason
class WrongKindOf(Reason, text="{path} is a {kind}, not {wanted}; inside it: {inside}", action=NAME_FIELDS):
    path: str; kind: str; wanted: Reason; inside: tuple[str, ...]
class AValue(Reason, text="a number, text, true/false or an array of these"): pass
class TextOrNumber(Reason, text="a text or a number"): pass
class ArrayOfTexts(Reason, text="an array of texts"): pass
class TimeOrSeconds(Reason, text="a time or a number of seconds"): pass

# the way to the database
class DatabaseAway(Reason, text="the database module is not there", action=PROCESSES): pass
class DatabaseSilent(Reason, text="the database module does not answer", action=PROCESSES): pass
