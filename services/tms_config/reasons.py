"""Faults of a configuration, and violations of its limits."""

from tms_reason.quantities import Radians
from tms_reason.reason import Reason
from tms_reason.remedies import EDIT_CONFIG, PROCESSES, STATUS, Remedy

# Remedies for configurations: all are done in an editor or a shell.
KEY_AS_TEXT = Remedy("edit_config", "", "Fill in the placeholder, or put the key in quotes")
READABLE = Remedy("edit_config", "", "Give the file to the user of this system, or name another file")
DOMAIN = Remedy("edit_config", "", "Use a number from 0 to 101, or unset the variable")
NO_PASSWORD = Remedy("edit_config", "", "Use user and password_file instead, or TMS_MONGODB_URI_FILE")
SAY_SOURCE = Remedy("edit_config", "", "Say its period, stamps and frozen_after")
FRAME_PREFIX = Remedy("edit_config", "", "Put the machine's name into the frame_prefix of the model's border")
SAY_PC = Remedy("say_pc", "tms up --role NAME", "Say which PC this is")
FULL_NAME = Remedy("processes", "tms ps", "Give the full name")


# fmt: off
# violations of limits
class BelowLimit(Reason, text="{angle} is below its limit {limit}"): angle: Radians; limit: Radians
class AboveLimit(Reason, text="{angle} is above its limit {limit}"): angle: Radians; limit: Radians

# where
class BadConfig(Reason, text="{problems}"): problems: tuple[Reason, ...]
class AndMore(Reason, text="and {count} more"): count: int
class BadFile(Reason, text="{file}: {problem}"): file: str; problem: Reason
class BadLine(Reason, text="{file}:{line}: {problem}"): file: str; line: int; problem: Reason
class BadKey(Reason, text="{file}:{line}: {key}: {problem}"): file: str; line: int; key: str; problem: Reason
class BadVariable(Reason, text="the variable {variable}: {problem}"): variable: str; problem: Reason

# files
class CannotBeRead(Reason, text="cannot be read ({problem})", action=READABLE): problem: str
class NotUtf8(Reason, text="is no UTF-8 text", action=EDIT_CONFIG): pass
class NoMapping(Reason, text="must hold keys and values", action=EDIT_CONFIG): pass
class NoYaml(Reason, text="is no YAML: {problem}", action=EDIT_CONFIG): problem: str
class KeyTwice(Reason, text="key '{name}' is there twice", action=EDIT_CONFIG): name: str
class NoKey(Reason, text="a key is itself a mapping or a list", action=KEY_AS_TEXT): pass
class NoMerge(Reason, text="only a mapping, or a list of mappings, can be merged with <<", action=EDIT_CONFIG): pass

# keys and values
class NoDomain(Reason, text="'{value}' is no ROS domain", action=DOMAIN): value: str
class NoUnit(Reason, text="there is no unit '{unit}' (there: {units}); SI values need none", action=EDIT_CONFIG):
    unit: str; units: tuple[str, ...]
class NotOrdered(Reason, text="[{least}, {most}] must be [least, most]", action=EDIT_CONFIG): least: float; most: float
class NoField(Reason, text="there is no such field under fields:", action=EDIT_CONFIG): pass

# machine files
class NoModel(Reason, text="there is no model '{model}' (there: {models})", action=EDIT_CONFIG):
    model: str; models: tuple[str, ...]
class NoBorder(Reason, text="there is no border '{backend}', which {site} uses", action=EDIT_CONFIG):
    backend: str; site: str
class NoSuchLink(Reason, text="'{name}' is neither a link of geometry: nor a joint of joints:",
    action=EDIT_CONFIG): name: str
class NoResponse(Reason, text="no dead time and lag for {name}, which moves: no stop could be proven",
    action=EDIT_CONFIG): name: str
class NoMover(Reason, text="{name} is no joint that moves, nor 'drive'", action=EDIT_CONFIG): name: str
class NotConvex(Reason, text="must be convex, from the rear lip over the back to the cutting edge",
    action=EDIT_CONFIG): pass
class NoParent(Reason, text="no joint above it has '{parent}' as its child", action=EDIT_CONFIG): parent: str
class NoSourceFacts(Reason, text="is missing: the border has this topic", action=SAY_SOURCE): pass
class NoTopic(Reason, text="the border has no topic '{name}'", action=EDIT_CONFIG): name: str
class ExtendsNothing(Reason, text="there is no border '{name}' to extend, only {known}", action=EDIT_CONFIG):
    name: str; known: tuple[str, ...]
class ExtendsItself(Reason, text="the border '{name}' extends itself by way of others", action=EDIT_CONFIG): name: str
class NoCodeFile(Reason, text="there is no file services/{path}", action=EDIT_CONFIG): path: str

# the site
class NoMachine(Reason, text="the site has no machine '{machine}' (there: {machines})",
    action=STATUS): machine: str; machines: tuple[str, ...]
class NoPlannedArm(Reason, text="{machine} has no arm whose motions are planned"): machine: str
class NotUnderMachines(Reason, text="there is no machine '{machine}' under machines: (there: {machines})",
    action=EDIT_CONFIG): machine: str; machines: tuple[str, ...]
class SharedFrames(Reason, text="{first} and {second} would share their frames ('{prefix}base_link')",
    action=FRAME_PREFIX): first: str; second: str; prefix: str
class NoService(Reason, text="there is no service '{service}' (there: {services})", action=EDIT_CONFIG):
    service: str; services: tuple[str, ...]
class PasswordInUri(Reason, text="the uri holds a password", action=NO_PASSWORD): pass
class HalfALogin(Reason, text="user and password_file go together: give both or none", action=EDIT_CONFIG): pass
class NoUri(Reason, text="user, password_file and TLS need the uri of a MongoDB", action=EDIT_CONFIG): pass
class TwoPlanners(Reason, text="with motions: true we serve their planner's names: that excludes planner: theirs",
    action=EDIT_CONFIG): pass
class FormNotSaid(Reason, text="say under forms: which form of {definition} they speak", action=EDIT_CONFIG):
    definition: str
class UserTwice(Reason, text="the user stands in uri and in user: keep the latter", action=EDIT_CONFIG): pass

# PCs
class NoRole(Reason, text="this PC has no role (there: {roles})", action=EDIT_CONFIG): roles: tuple[str, ...]
class NoPcFor(Reason, text="no PC would run {process} (role {role}): set roles: or machines: of one PC",
    action=EDIT_CONFIG): process: str; role: str
class ManyPcsFor(Reason, text="{pcs} would all run {process} (role {role}): set roles: or machines: of one PC",
    action=EDIT_CONFIG): pcs: tuple[str, ...]; process: str; role: str
class NoSuchPc(Reason, text="the site has no PC '{pc}' (there: {pcs})", action=SAY_PC): pc: str; pcs: tuple[str, ...]
class WhichPc(Reason, text="site '{site}' has several PCs: {pcs}", action=SAY_PC): site: str; pcs: tuple[str, ...]
class NoCps(Reason, text="the discovery server runs on the PC with the role cps, and there is none",
    action=EDIT_CONFIG): pass
class NoAddress(Reason, text="'{name}' cannot be resolved ({problem})", action=EDIT_CONFIG): name: str; problem: str

# processes
class SameName(Reason, text="two processes are called '{process}'", action=EDIT_CONFIG): process: str
class NoProcess(Reason, text="there is no process '{name}'", action=PROCESSES): name: str
class ProcessMeant(Reason, text="there is no process '{name}': did you mean {near}?", action=PROCESSES):
    name: str; near: str
class SeveralProcesses(Reason, text="'{name}' fits {processes}", action=FULL_NAME):
    name: str; processes: tuple[str, ...]
# fmt: on
