"""Reasons why a command of `tms` failed."""

from tms_reason.quantities import Megabytes, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import LOGS, PROCESSES, RECORDS, RETRY, RUNS, STATUS, TASKS, Remedy

QUESTIONS = Remedy("questions", "tms answer", "See which questions are open")
CHOOSE = Remedy("questions", "tms answer --question ID", "Choose one of them")
MORE_OF_ID = Remedy("runs", "tms runs", "Give more of the id")
EVENTS = Remedy("look", "tms events {run}", "Look at the machine, then at what happened")
INSPECT_STATUS = Remedy("look", "tms status", "Look at the machine, then see what is wrong")
AS_CONSOLE = Remedy("account", "", "Run this as the user of the console")
OTHER_PLACE = Remedy("file", "", "Choose another place")
OTHER_NAME = Remedy("file", "", "Choose another name")
AS_OWNER = Remedy("file", "", "Choose another place, or a user of this PC who may use this one")
TASK_FILE = Remedy("file", "", "Give a task's XML file")
DEEPER = Remedy("file", "", "Look into its folders, too: --recursive")
OTHER_BROWSER = Remedy("link", "", "Open {url} in another browser")
SIMULATION = Remedy("site", "", "Choose a site with backend 'sim', at least one machine and no pcs:")
DRILL_END = Remedy("wait", "", "Wait for its end")
NO_ROLE = Remedy("role", "make up", "Leave ROLE away: this PC runs all of it")
USERS = Remedy("users", "tms user list", "See which users there are")
ADD_USERS = Remedy("edit_config", "", "Add console.users to the site file, or use --file")
HOST_AND_PORT = Remedy("edit_config", "", "Write it like 127.0.0.1:9093")
STATE_ELSEWHERE = Remedy("edit_config", "", "Free some space, or set TMS_STATE to another folder")
OTHER_DOMAIN = Remedy("edit_config", "", "Run `make down` there, or give this mesh another domain and other ports")
OTHER_PORTS = Remedy("edit_config", "", "Stop it, or change ports: in {file}")
SUPERVISORD_LOG = Remedy("file", "", "Read {log}")
SENSING_RUNS = Remedy("processes", "tms ps", "See whether `sp` is under services: of the site file, and runs")
QUOTES = Remedy("value", "", "Put text with special characters in quotes")
FINITE = Remedy("value", "", "Write a number, or '\"{value}\"' if text is meant")
EMPTY_TEXT = Remedy("value", "", "Write \"''\" for an empty text, or use --remove")
OTHER_TOPICS = Remedy("topics", "", "Stop that, or choose others with --topics")
SAME_SENSING = Remedy("processes", "tms ps", "See whether tms:sp runs, with this sensing.yaml")
GIVE_SUBTASK = Remedy("subtask", "", "Give one of them: --subtask NAME")
KEEP_STAMPS = Remedy("stamps", "", "Play with --keep-stamps")


# fmt: off
# runs and questions
class SchedulerSilent(Reason, text="the scheduler says nothing", action=STATUS): pass
class NobodyAsks(Reason, text="there are no open questions", action=QUESTIONS): pass
class NobodyAsksThis(Reason, text="there is no question '{question}'", action=QUESTIONS): question: str
class ManyQuestions(Reason, text="{count} questions are open: {questions}", action=CHOOSE):
    count: int; questions: tuple[str, ...]
class NoRunActive(Reason, text="no run is active", action=RUNS): pass
class NoRunInterrupted(Reason, text="no run is interrupted", action=RUNS): pass
class RunHasEnded(Reason, text="run {run} has ended already: {state}", action=RUNS): run: str; state: str
class NotEndedYet(Reason, text="run {run} has not ended {seconds} after the cancel", action=EVENTS):
    run: str; seconds: Seconds
class SchedulerQuiet(Reason, text="the scheduler has said nothing for {seconds} (run {run})", action=INSPECT_STATUS):
    seconds: Seconds; run: str
class SchedulerForgot(Reason, text="the scheduler was restarted and does not know the run any more (run {run})",
    action=INSPECT_STATUS): run: str
class RunUnknown(Reason, text="there is no run '{run}'", action=RUNS): run: str
class ManyRuns(Reason, text="'{run}' fits {count} runs ({runs}, ...)", action=MORE_OF_ID):
    run: str; count: int; runs: tuple[str, ...]
class TaskUnknown(Reason, text="there is no task {task}", action=TASKS): task: str

# processes of this PC
class NoPcs(Reason, text="{file} has no pcs:", action=NO_ROLE): file: str
class NotWritable(Reason, text="{file} cannot be written ({problem})", action=OTHER_PLACE): file: str; problem: str
class StateNotWritable(Reason, text="{folder} cannot be written ({problem})", action=STATE_ELSEWHERE):
    folder: str; problem: str
class LittleRoom(Reason, text="{folder}: only {free} free", action=STATE_ELSEWHERE): folder: str; free: Megabytes
class DomainTaken(Reason, text="ROS domain {domain} is used by another mesh on this PC, its state is in {folder}",
    action=OTHER_DOMAIN, details="pid {pid}"): domain: int; pid: int; folder: str
class PortInUse(Reason, text="port {port} ({purpose}) is taken by {holder}", action=OTHER_PORTS, details="{problem}"):
    port: int; purpose: str; holder: str; file: str; problem: str
class SupervisordNotUp(Reason, text="supervisord did not start", action=SUPERVISORD_LOG): log: str
class SupervisordFailed(Reason, text="supervisord did not start: {words}"): words: str
class PidsLeft(Reason, text="these processes did not end: {pids}", action=SUPERVISORD_LOG):
    pids: tuple[int, ...]; log: str
class NotReadyAfter(Reason, text="{process} is not ready after {seconds}: {why}", action=LOGS):
    process: str; seconds: Seconds; why: Reason
class NotStarted(Reason, text="{process} does not start", action=LOGS): process: str
class EndsAgain(Reason, text="{process} ends again and again", action=LOGS): process: str
class NoLog(Reason, text="there is no log in {folder} yet", action=PROCESSES): folder: str
class SystemSays(Reason, text="{problem}", action=STATUS): problem: str
class FileRefused(Reason, text="{file}: {problem}", action=AS_OWNER): file: str; problem: str

# files, values, users
class Unreadable(Reason, text="{file} cannot be read ({problem})", action=AS_CONSOLE): file: str; problem: str
class NoTaskFile(Reason, text="{file} is no file", action=TASK_FILE): file: str
class NoXmlFiles(Reason, text="{folder}: there are no .xml files in it or its folders"): folder: str
class NoXmlHere(Reason, text="{folder}: there are no .xml files in it", action=DEEPER): folder: str
class InTaskFile(Reason, text="{file}: {why}"): file: str; why: Reason
class NameTaken(Reason, text="{file} cannot be written ({problem})", action=OTHER_NAME): file: str; problem: str
class NoAreas(Reason, text="the site has no areas: {folder} holds no .geojson file"): folder: str
class PlacesUntold(Reason, text="{process} does not tell who holds which place", action=PROCESSES): process: str
class AreaFileUnread(Reason, text="{file} cannot be read ({problem})", action=OTHER_PLACE): file: str; problem: str
class AreaFileThere(Reason, text="{file} is there already", action=OTHER_NAME): file: str
class NoBrowser(Reason, text="there is no chromium on this PC", action=OTHER_BROWSER): url: str
class FieldValue(Reason, text="{where}, field {field}: {why}"): where: str; field: str; why: Reason
class NotAFiniteNumber(Reason, text="{value} is not a finite number", action=FINITE): value: str
class ValueUnreadable(Reason, text="{value} cannot be read", action=QUOTES): value: str
class ValueEmpty(Reason, text="the value is empty", action=EMPTY_TEXT): pass
class BeforeThat(Reason, text="{why} (before that: {done})"): why: Reason; done: str
class BadUserName(Reason, text="'{name}' is no user name: letters, digits and _ - . only"): name: str
class ShortPassword(Reason, text="a password has {least} characters at least"): least: int
class NoUser(Reason, text="{file}: there is no user '{name}'", action=USERS): file: str; name: str
class NoUsersKey(Reason, text="{file}: console.users names no file", action=ADD_USERS): file: str
class NoHostPort(Reason, text="where alerts go is no HOST:PORT: '{address}'", action=HOST_AND_PORT): address: str

class WhichSubtask(Reason, text="record {record}: for which subtask is it ({subtasks})?", action=GIVE_SUBTASK):
    record: str; subtasks: tuple[str, ...]
class RecordUnfitFor(Reason, text="record {record} does not fit {subtask}: {why}", action=RECORDS):
    record: str; subtask: str; why: Reason
class ForNoArm(Reason, text="record {record} is for no subtask that moves the arm", action=RECORDS): record: str

class CannotRun(Reason, text="it cannot run as it is: {why}"): why: Reason

# sensing and its recordings
class SensingSilent(Reason, text="the sensing module says nothing", action=SENSING_RUNS): pass
class NothingToPlay(Reason, text="nothing to play: {topics}"): topics: tuple[str, ...]
class EmptyRecording(Reason, text="nothing to play: it holds no topics"): pass
class NoSuchTopic(Reason, text="no {topics} in the recording (there: {others})"):
    topics: tuple[str, ...]; others: tuple[str, ...]
class NobodyListens(Reason, text="the sensing module does not listen to {topics}", action=SAME_SENSING):
    topics: tuple[str, ...]
class TwoSources(Reason, text="others publish {topics} now", action=OTHER_TOPICS): topics: tuple[str, ...]
class StampFixed(Reason, text="the stamp {path} cannot be replaced", action=KEEP_STAMPS): path: str
class BeginsLate(Reason, text="{file} is {length} long, so nothing begins at {start}"):
    file: str; length: Seconds; start: Seconds
class BadBag(Reason, text="{problem}"): problem: str

# the drill
class NotForDrill(Reason, text="{file}: the drill kills processes on purpose", action=SIMULATION): file: str
class DrillRuns(Reason, text="{site}: a drill runs already", action=DRILL_END): site: str
class NotRunning(Reason, text="{processes} does not run", action=PROCESSES): processes: tuple[str, ...]
class DoesNotMove(Reason, text="its run does not move it: {why}"): why: Reason
class NoControlPort(Reason, text="the stand-in of OperaSim-PhysX does not answer at its control port",
    action=SUPERVISORD_LOG): log: str
class NobodySays(Reason, text="no reason was given"): pass
class StandInsEnded(Reason, text="{processes} has ended", action=SUPERVISORD_LOG): processes: tuple[str, ...]; log: str
class RunDoesNotEnd(Reason, text="run {run} does not end", action=RETRY): run: str
