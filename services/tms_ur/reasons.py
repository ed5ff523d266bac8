"""Reasons why the console refuses a request or cannot work, and faults of its settings."""

from tms_reason.quantities import Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import CHECK, EDIT_CONFIG, INSPECT, LOGS, PROCESSES, REARM, RETRY, RUNS, STATUS, Remedy

ADD_USER = Remedy("users", "tms user add NAME --role admin", "Add its users")


# fmt: off
# the person or program that asks
class Login(Reason, text="{why}"): why: Reason  # the remedy is always the same: log in
class NobodyLoggedIn(Reason, text="log in first",
    details="POST /api/login, or `Authorization: Bearer NAME:TOKEN`"): pass
class WrongPassword(Reason, text="the name or the password is wrong"): pass
class Throttled(Reason, text="too many wrong passwords: try again in {seconds}"): seconds: Seconds
class ManyLogins(Reason, text="too many passwords are being checked", action=RETRY): pass
class NoUsers(Reason, text="this site has no users: no login is needed"): pass
class Role(Reason, text="this needs the role {role}, {person} is {has}"): role: str; person: str; has: str
class NoAccessControl(Reason, text="others can connect to {bind}, and the console has no users: commands are refused",
    action=EDIT_CONFIG,
    details="console.users names a file of users; `bind: 127.0.0.1` keeps others out"):
    bind: str

# the form of a request
class Crowded(Reason, text="too many requests are being answered; a stop is answered always", action=RETRY): pass
class ForeignHost(Reason, text="this console does not answer to the name '{host}'",
    action=EDIT_CONFIG,
    details="open http://{bind} or http://localhost, or add the name to console.names"):
    host: str; bind: str
class ForeignOrigin(Reason, text="commands from pages of '{origin}' are refused: use the console's own"):
    origin: str
class NotJson(Reason, text="a command needs `Content-Type: application/json`"): pass
class NoLength(Reason, text="a command needs a Content-Length"): pass
class RequestTooLarge(Reason, text="this command has {most} bytes at most"): most: int
class BadRequest(Reason, text="{where}: {problem}", details="see /openapi.json"): where: str; problem: str
class NotFound(Reason, text="{method} {path}: there is no such page",
    details="see /openapi.json"): method: str; path: str
class MethodNotAllowed(Reason, text="{method} {path}: this method is not offered",
    details="see /openapi.json"): method: str; path: str
class InternalError(Reason, text="{error} in the console: this is a bug", action=LOGS): error: str; process: str

# values of records
class BadValue(Reason, text="{field}: {value}: {why}"): field: str; value: str; why: Reason
class AngleUnfit(Reason, text="{joint}: {why}"): joint: str; why: Reason
class NotOfType(Reason, text="this is no {type}"): type: str
class IntTooLong(Reason, text="an int has 64 bits"): pass
class NotFinite(Reason, text="a double is finite"): pass
class NotUnicode(Reason, text="a string is valid Unicode without NUL"): pass

# the site
class UnknownProcess(Reason, text="no PC of the site has a process '{process}'", action=PROCESSES): process: str
class NoLogAsked(Reason, text="say of which machine or run: machine, run_id"): pass
class RunNotFound(Reason, text="the history holds no run {run}", action=RUNS): run: str
class NoTree(Reason, text="the journal of run {run} holds no tree: it was refused, or is an old one",
    action=RUNS): run: str
class JournalCut(Reason, text="cut after {count} events",
    details="the rest is at /api/runs/{run}/events?after={last}"): count: int; run: str; last: int
class TooManyConsoles(Reason, text="{most} consoles are connected already: close one of them"): most: int
class Starting(Reason, text="task {task} is being started already"): task: int
class CyclesNotRead(Reason, text="a cycle of work cannot be read: {why}"): why: Reason
class GroundNotRead(Reason, text="the ground of {time} cannot be read ({problem})"):
    time: str; problem: str
class StartRefused(Reason, text="the scheduler did not take the task", action=LOGS): process: str
class MachineUnheard(Reason, text="{process} has not reported yet", action=PROCESSES): process: str
class MachineSilent(Reason, text="{process} has said nothing for {age}", action=PROCESSES): process: str; age: Seconds

# alarms, as deploy/prometheus/rules.yml tells them
class StopNotSeen(Reason, text="{machine} was told to stop and was not seen to stand", action=REARM,
    details="keep away from the machine, look at it, use its own emergency stop"): machine: str
class LatchHeld(Reason, text="{machine} has been stopped for long and waits for a person to re-arm it",
    action=REARM): machine: str
class NewsOld(Reason, text="nothing is heard of {machine}: its joint states or odometry are old", action=INSPECT,
    details="a machine that is not heard is not moved: is it switched on, and its PC in the network?"): machine: str
class TwoGateways(Reason, text="{machine} has two gateways: only the first one serves, and takes no goals",
    action=STATUS, details="two PCs of the site, or two sites in one ROS domain, have this machine"): machine: str
class StoodIn(Reason, text="the gateway of {machine} was lost: the host agent has stopped the machine in its place",
    action=LOGS): machine: str; process: str
class PcSilent(Reason, text="PC {pc} says nothing: its power or network", action=STATUS): pc: str
class ProcessDown(Reason, text="process {process} does not run", action=LOGS): process: str
class NoWord(Reason, text="process {process} does not answer", action=LOGS): process: str
class DiscoveryDown(Reason,
    text="the discovery server does not run: processes that start do not find the others", action=LOGS,
    details="connections that are there go on"): process: str
class LongUnready(Reason, text="process {process} has not been able to work for a while", action=LOGS): process: str
class CrashLoop(Reason, text="process {process} ends again and again", action=LOGS): process: str
class InputQuiet(Reason, text="sensing input {input} has fallen silent",
    details="is the sensing PC on, does its node publish? Records with max_age refuse to be used meanwhile"): input: str
class PrometheusAway(Reason, text="Prometheus at {address} does not tell its alerts", details="{problem}",
    action=EDIT_CONFIG): address: str; problem: str
class SensingClockOff(Reason, text="the clock behind sensing input {input} is off",
    details="`chronyc tracking` on the sensing PC: the age of its values is not known"): input: str

# the console itself
class ServerEnded(Reason, text="the web server has ended", action=LOGS): process: str
class ServerStarting(Reason, text="the web server is not up yet", action=RETRY): pass
class CannotListen(Reason, text="{file}: ports.console: cannot listen on port {port} of {bind} ({problem})",
    action=EDIT_CONFIG,
    details="stop the program that uses the port, or change ports.console or bind"):
    file: str; port: int; bind: str; problem: str
class UnreadableCertificate(Reason, text="{file}: console.tls.{name}: {path}: cannot be read ({problem})",
    action=EDIT_CONFIG): file: str; name: str; path: str; problem: str
class NoCertificate(Reason, text="{file}: console.tls: {certificate} and {key} are no PEM certificate, key ({problem})",
    action=EDIT_CONFIG): file: str; certificate: str; key: str; problem: str
class NoUsersFile(Reason, text="{file}: the users file of console.users is not there",
    action=ADD_USER): file: str
class UnreadableUsers(Reason, text="{file}: the users file of console.users cannot be read ({problem})",
    action=CHECK): file: str; problem: str
class UsersForAll(Reason, text="{file}: all users of this PC may read it: `chmod 600 {file}`", action=CHECK): file: str
class NoTaskSequence(Reason, text="the message on /task_sequence holds no tasks"): pass
# fmt: on
