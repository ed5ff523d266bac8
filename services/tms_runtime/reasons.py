"""Why a process cannot begin or work, why a text is no task, and what a PC's disk does not take."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_TASK, LOGS, OTHER_FOLDER, RESTART, RETRY, STATUS, Remedy

OTHER_PORT = Remedy("edit_config", "", "Stop the other program, or change ports.metrics in the site file")


# fmt: off
# processes
class ProcessStarting(Reason, text="it is starting", action=RETRY): pass
class PortSilent(Reason, text="{process} does not answer on its health port", action=LOGS): process: str
class PortTaken(Reason, text="port {port} on {address} is taken ({problem})", action=OTHER_PORT):
    port: int; address: str; problem: str
class ParentGone(Reason, text="supervisord ended while this process started"): pass
class PcBusy(Reason, text="its PC was too busy for {seconds}"): seconds: Seconds
class LongCallback(Reason, text="a callback took {seconds}, or the process was frozen"): seconds: Seconds
class Hangs(Reason, text="{process} has not run for {seconds}", action=RESTART): process: str; seconds: Seconds
class NotConnected(Reason, text="{reader} does not receive what {writer} publishes", details="{topic}: {problem}"):
    topic: str; reader: str; writer: str; problem: str

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
class XmlLine(Reason, text="line {line}: {what}", action=EDIT_TASK): line: int; what: Reason
class XmlHint(Reason, text="{what}: {hint}"): what: Reason; hint: Reason

# the disk of this PC
class NotStored(Reason, text="{end} (not stored yet: the disk of the scheduler's PC is slow or full)", action=STATUS):
    end: Reason
class OthersFile(Reason, text="belongs to another user, and others may read it", action=OTHER_FOLDER,
    details="or give the folder to this user: `chown -R {user}`"): user: int
