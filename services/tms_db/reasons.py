"""Reasons why the database module refuses a request, and faults of its store and its files.

`record` is MODEL/NAME, /NAME for a shared one; `place` is a record or one of its fields, or a place in a file.
"""

from tms_reason.quantities import Megabytes, Seconds
from tms_reason.reason import Reason
from tms_reason.remedies import (
    ADD_RECORD,
    CANCEL,
    EDIT_CONFIG,
    EDIT_TASK,
    LOGS,
    PROCESSES,
    RETRY,
    RUNS,
    TASKS,
    TEMPLATES,
    Remedy,
)

DYNAMIC = Remedy("records", "tms param set {record} --type dynamic", "Make it dynamic, if sensing is to write it")
ADD_FIELDS = Remedy("records", "tms param set {place} FIELD=VALUE", "Add the fields")
REPLACE = Remedy("templates", "tms template add --replace FILE", "Choose another name, or replace it")
WHOLE = Remedy("file", "tms db restore FILE", "Restore the whole database")
OTHER_ARCHIVE = Remedy("file", "tms db backup", "Give the archive of a backup, or what mongodump wrote")
OLDER = Remedy("restore", "tms db restore FILE", "Install the newer program, or restore a backup from before")
START_STORE = Remedy("processes", "tms start tms:store", "Start it, or the MongoDB of the site")
TERRAINS = Remedy("terrain", "tms terrain list", "See what is stored")
REMOVE_TERRAIN = Remedy("terrain", "tms terrain rm {name}", "Remove it first")
ADD_TERRAIN = Remedy("terrain", "tms terrain add FILE", "Store its file")
GROUNDS = Remedy("ground", "tms ground list", "See what is stored")
FOLDER = Remedy("file", "", "Give a folder of the C++ system, or what mongodump wrote")


# fmt: off
# records
class RecordMissing(Reason, text="there is no record {record}", action=ADD_RECORD): record: str
class RecordLocked(Reason, text="record {record} is locked by {owner} until the machine has moved with it",
    code="LOCKED_RECORD"): record: str; owner: str
class StaticInUse(Reason, text="record {record} is static and run {run} uses it: wait until the run has ended",
    code="STATIC_RECORD"): record: str; run: str
class StaticFromSensing(Reason,
    text="record {record} is static, so sensing does not write it", action=DYNAMIC): record: str
class AgeUnknown(Reason, text="record {record} may be {limit} old, but its age is not known: let sensing write it"):
    record: str; limit: Seconds
class FromFuture(Reason,
    text="record {record}: its time lies in the future (last from {source}): let sensing write it"):
    record: str; source: str
class TooOld(Reason, text="record {record} is {age} old, allowed are {limit} (last from {source})"):
    record: str; age: Seconds; limit: Seconds; source: str
class NotChanged(Reason, text="record {record} was not changed: {others}", code="CONFLICT"):
    record: str; others: tuple[Reason, ...]
class OtherValue(Reason, text="{field} is {value}, not {wanted}"): field: str; value: str; wanted: str
class OtherFields(Reason, text="its fields were others"): pass
class MadeByOthers(Reason, text="record {record} is being made and removed by others", action=RETRY): record: str
class NameEmpty(Reason, text="record_name is empty: give the record a name"): pass
class BadRecordName(Reason, text="{what} '{name}' {why}"): what: str; name: str; why: Reason
class BadType(Reason, text="{place}: type is '{type}': write static or dynamic"): place: str; type: str
class BadMaxAge(Reason, text="{place}: max_age is {value}: write seconds, for example 2.0"): place: str; value: str
class StaticWithAge(Reason,
    text="{place}: a static record cannot get too old: make it dynamic, or take max_age away"): place: str
class HoldsControl(Reason, text="{place}: {what} {letter}: remove it"): place: str; what: str; letter: Reason
class NoFieldName(Reason, text="{place}: a field has no name or a name that is no text ({name}): write a name"):
    place: str; name: str
class ReservedField(Reason, text="{place}: field '{field}' is reserved: choose another name"): place: str; field: str
class DollarOrDot(Reason,
    text="{place}: field name '{field}' must not start with $ or hold dots: choose another name"):
    place: str; field: str
class BadFieldName(Reason, text="{place}: field name '{field}' {why}"):
    place: str; field: str; why: Reason
class FieldNoArray(Reason, text="{place} is no array"): place: str
class NoArrayChange(Reason, text="'{change}' changes no array: send add, push, remove or reset, and one value"):
    change: str
class MixedArray(Reason, text="{place}: the array mixes types: use numbers only, or one other type"): place: str
class HoldsNul(Reason, text="{place}: the text holds a NUL character: remove it"): place: str
class TooManyBits(Reason, text="{place}: {value} does not fit into 64 bits: write a smaller number"):
    place: str; value: str
class NoFiniteNumber(Reason, text="{place}: {value} is not a finite number: write a number"): place: str; value: str
class CannotBeStored(Reason,
    text="{place}: {kind} cannot be stored: use a number, true/false, text or an array of these"):
    place: str; kind: str
class NoValueGiven(Reason, text="{place}: no value, or bytes: use a number, true/false, text or an array of these"):
    place: str
class FieldTwice(Reason, text="{place}: field {field} is there twice: send it once"): place: str; field: str
class SetAndRemoved(Reason, text="{place}: field {field} is to be set and removed: choose one"): place: str; field: str
class NoneOfFields(Reason, text="{place} has none of the fields {fields}", action=ADD_FIELDS):
    place: str; fields: tuple[str, ...]
class OtherKind(Reason, text="{place} holds {stored}, not {given}: send the same kind, or change the record"):
    place: str; stored: str; given: str

# files of records
class RecordFileLarge(Reason, text="{place}: is larger than {limit}: is this the right file?"):
    place: str; limit: Megabytes
class NoRecordList(Reason, text="{place}: must hold a list of records, each starting with '- record_name:'"): place: str
class RecordTwice(Reason, text="{place}: {record} is there twice: remove one"): place: str; record: str
class NoKeysAndValues(Reason, text="{place}: must hold keys and values, not {kind}"): place: str; kind: str
class KeyIsNoText(Reason,
    text="{place}: {key} is {value}, not text: put it in quotes"):
    place: str; key: str; value: str
class ExponentIsText(Reason, text="{place}: YAML reads {value} as text: write it with a dot, like 1.0e-3"):
    place: str; value: str
class InFilePlace(Reason, text="{place}: {why}"): place: str; why: Reason

# machine states, runs
class NoCollection(Reason, text="there is no collection '{name}' for machine states (there: {names})"):
    name: str; names: tuple[str, ...]
class StateNoJson(Reason, text="{collection} of {machine}: is no JSON ({problem})"):
    collection: str; machine: str; problem: str
class StateNoObject(Reason, text="{collection} of {machine}: must be a JSON object"): collection: str; machine: str
class NoStateTime(Reason, text="the newest state of a machine has the time '{time}', which is none"): time: str
class RecordingDamaged(Reason, text="the recording of {machine} at {time} is damaged ({why}): nobody can read it"):
    machine: str; time: str; why: str
class RunMissing(Reason, text="there is no run '{run}'", action=RUNS): run: str
class NoEventNumber(Reason, text="event {number} of run {run}: needs a number from 1"): number: int; run: str
class BadRunId(Reason, text="run_id '{run}' {why}"): run: str; why: Reason
class RivalScheduler(Reason, text="another process writes the same journal: only one scheduler may run",
    action=PROCESSES): pass

# shared places
class PlacesUnreadable(Reason, text="the book of shared places in the database cannot be read", action=PROCESSES): pass

# tasks
class TaskMissing(Reason, text="there is no task {task}", action=TASKS): task: int
class NoTaskNumber(Reason, text="no free task number after {attempts} attempts", action=RETRY): attempts: int
class TaskFileLarge(Reason, text="{file}: is {size}, larger than {limit} bytes"): file: str; size: Megabytes; limit: int
class UnreadableFile(Reason, text="{file}: cannot be read ({problem}): check the name"): file: str; problem: str
class FileNotUtf8(Reason, text="{file}: is not UTF-8 text (byte {byte}): save it as UTF-8"): file: str; byte: int
class OuterElement(Reason, text="line {line}: the outermost element is <{tag}>, not <root>: export it from Groot",
    action=EDIT_TASK): line: int; tag: str
class NoTreeInRoot(Reason, text="line {line}: there is no <BehaviorTree> with nodes in <root>: export it from Groot",
    action=EDIT_TASK): line: int
class NoFileGiven(Reason, text="no file is given: add --ros-args -p bt_tree_xml_file_name:=NAME"): pass
class NoSuchFile(Reason, text="no file '{name}' here and no '{name}.xml' in {folder}: check bt_tree_xml_file_name"):
    name: str; folder: str

# templates
class TemplateMissing(Reason, text="there is no template '{template}'", action=TEMPLATES): template: str
class BadTemplateName(Reason, text="template name '{name}' {why}"): name: str; why: Reason
class TemplateExists(Reason, text="template '{template}' is stored with another text", action=REPLACE): template: str

# an import of the C++ system's files
class NoSuchSource(Reason, text="{path}: there is no such folder or file", action=FOLDER): path: str
class ImportNothing(Reason, text="{path}: there are no trees and records in it", action=FOLDER): path: str
class NoTreeInFile(Reason, text="no tree: there is no <BehaviorTree> in it"): pass
class NoRecordsInFile(Reason, text="no records: neither a list of records nor initial_parameters"): pass
class NoCollectionOfTasks(Reason, text="'{name}' is neither task, subtask nor parameter", action=WHOLE): name: str
class DocumentNotRead(Reason, text="cannot be read ({problem})"): problem: str
class DocumentTooLarge(Reason, text="is larger than {limit}", action=WHOLE): limit: Megabytes
class NoTaskText(Reason, text="the document has no task_sequence"): pass
class NumberTaken(Reason, text="task {old} becomes task {new}, as there is another task {old}"): old: int; new: int
class TemplateTwice(Reason, text="there are two templates '{template}' with different texts"): template: str
class RecordDiffers(Reason, text="record {record} is there with other values: --replace takes these"): record: str
class RecordSplit(Reason, text="one record for each of {models}"): models: tuple[str, ...]
class FieldAsItIs(Reason, text="kept, but nothing here reads it: {why}"): why: Reason
class TypeAsItIs(Reason, text="type '{type}' counts as dynamic"): type: str
class ImportedInPart(Reason, text="{why}; what had been imported could not be taken back: import the same folder "
    "again"): why: Reason

# terrain
class TerrainMissing(Reason, text="there is no terrain '{name}'", action=TERRAINS): name: str
class TerrainNotWhole(Reason, text="terrain {name} is not there, or not whole: store it again"): name: str
class TerrainExists(Reason, text="terrain {type} {name} is there already", action=REMOVE_TERRAIN):
    type: str; name: str
class TerrainSizes(Reason,
    text="{file}: a {type} needs its width, height and elevation in metres"):
    file: str; type: str
class TerrainSigns(Reason, text="{file}: width and height must be above 0 m and elevation not below: correct them"):
    file: str
class BadTerrainName(Reason, text="terrain name '{name}' {why}"): name: str; why: Reason
class TerrainEnding(Reason, text="{file}: a file of type {type} ends with {ending}"): file: str; type: str; ending: str
class TerrainNoFile(Reason, text="{file}: there is no such file: check the name"): file: str
class TerrainNoRegular(Reason, text="{file}: is no regular file: check the name"): file: str
class TerrainLarge(Reason, text="{file}: is {size}, {limit} are allowed: make it coarser"):
    file: str; size: Megabytes; limit: Megabytes
class TerrainBegins(Reason, text="{file}: does not begin as a {ending} file does: is this the right file?"):
    file: str; ending: str
class NoPng(Reason, text="{file}: is no PNG image: is this the right file?"): file: str
class ImageEnds(Reason, text="{file}: the image ends in the middle: copy it again"): file: str
class ImageDamaged(Reason, text="{file}: the image is damaged (checksum at byte {byte}): copy it again"):
    file: str; byte: int
class ImageNoHeader(Reason, text="{file}: the image has no header: copy it again"): file: str
class ImageSides(Reason,
    text="{file}: is {width} x {height} pixels, at most {most} a side are allowed: make it smaller"):
    file: str; width: int; height: int; most: int
class NoHeightPixels(Reason, text="{file}: a heightmap has 8-bit or 16-bit grey pixels, not {found}: convert it"):
    file: str; found: str
class NoColourPixels(Reason, text="{file}: a texture has 8-bit colour pixels, not {found}: convert it"):
    file: str; found: str
class ImageUnreadable(Reason, text="{file}: the image cannot be read ({problem}): store it again"):
    file: str; problem: str
class ImageMode(Reason, text="{file}: is {size} pixels of mode {mode}: store another image"):
    file: str; size: str; mode: str
class CloudLarge(Reason, text="a cloud of {size}, {limit} are allowed: thin it out"): size: Megabytes; limit: Megabytes
class CloudSizes(Reason, text="a cloud of {size} bytes whose sizes say {wanted}: correct its sender"):
    size: int; wanted: int
class CloudForeign(Reason, text="{file}: holds no description of its points, so it is not one of ours"): file: str
class TerrainOverRos(Reason,
    text="terrain {name} of type '{type}' came over ROS", action=ADD_TERRAIN): name: str; type: str
class NoImageType(Reason, text="terrain type '{type}': an image is one of {types}"): type: str; types: tuple[str, ...]

# the ground and the work
class GroundNotThere(Reason, text="there is no ground of '{time}'", action=GROUNDS): time: str
class GroundUnreadable(Reason, text="the ground of {time} is damaged: import its file again"): time: str
class GroundNotHeights(Reason, text="that is no ground: {problem}"): problem: str
class NoZone(Reason, text="'{time}' is no time with a zone: write 2026-11-26T13:05:00+09:00"):
    time: str
class BadCycle(Reason, text="a cycle of work cannot be stored: {why}"): why: Reason
class CycleUnreadable(Reason, text="the stored cycle {cycle} cannot be read: {why}"): cycle: str; why: Reason

# the store
class EmptyFile(Reason, text="is empty", action=EDIT_CONFIG): pass
class StoreDown(Reason, text="{why}"): why: Reason
class NoStore(Reason, text="the store does not answer; the database module reconnects by itself",
    action=START_STORE): pass
class StoreUnusable(Reason, text="the store cannot be used: {why}"): why: Reason
class NoVouching(Reason,
    text="store.tls_ca does not vouch for its certificate, or that is for another host name"): pass
class WantsCertificate(Reason, text="it wants a certificate of ours: give store.tls_certificate"): pass
class TlsFails(Reason, text="TLS with it fails: see store.tls_ca, and whether it speaks TLS"): pass
class NoPrimary(Reason, text="no member of its replica set is the primary: start more of them"): pass
class NoMember(Reason, text="none of its hosts is a member of the replica set that the URI names"): pass
class StoreLogin(Reason,
    text="the store refuses our login: check user and password (store.password_file, or TMS_MONGODB_URI)"): pass
class StoreSilent(Reason,
    text="the store gave no answer in {limit}: see whether its disk is full or the PC overloaded"): limit: Seconds
class StoreFull(Reason, text="the store's disk is full: free some space, then try again"): pass
class StoreSlow(Reason, text="the store does not get done with earlier updates", action=PROCESSES): pass
class ManyRecordsWait(Reason, text="too many records wait for the store: send less", action=PROCESSES): pass
class StoreRefused(Reason, text="the store refused the request ({problem})", action=LOGS): problem: str; process: str
class StoreRefusedUpdate(Reason, text="the store refused an update ({problem})", action=LOGS):
    problem: str; process: str
class StoreFailed(Reason, text="the store could not do it ({problem})", action=LOGS): problem: str; process: str
class TooLarge(Reason, text="the document is larger than the store's 16 MB: make it smaller"): pass
class DocumentUnreadable(Reason,
    text="a stored document cannot be read ({problem}): correct or remove it"):
    problem: str
class TwoWithOneKey(Reason, text="database {database}, collection {collection}: two documents with the same key {key}: "
    "remove one of them, then start again", code="STORE_CONFLICT"): database: str; collection: str; key: str
class NewerSchema(Reason, text="{place} has schema {found}, this program ({version}) knows {known}",
    action=OLDER, code="STORE_NEWER"):
    place: str; found: int; version: str; known: int
class StoreAddress(Reason, text="the store's address {address} is wrong ({problem}): "
    "write mongodb://host:port in TMS_MONGODB_URI or store.uri, with % codes for special characters"):
    address: str; problem: str
class StoreFile(Reason, text="store: {file} cannot be used ({problem}): see store.tls_ca"): file: str; problem: str

# backups
class FileExists(Reason, text="{file} is there already: choose another name, or --overwrite"): file: str
class FileNotWritten(Reason,
    text="{file}: cannot be written ({problem}): choose another place"):
    file: str; problem: str
class NotEmpty(Reason, text="database {database} is not empty ({holds}): --drop replaces all of it"):
    database: str; holds: str
class RunActive(Reason, text="run {run} is active in database {database}: end it first", action=CANCEL):
    run: str; database: str
class ReplacedInPart(Reason,
    text="{why}; database {database} is replaced only in part: run the same restore with --drop again"):
    why: Reason; database: str
class NoDatabaseIn(Reason, text="{file}: holds no database {database} (there: {names}): dump that one alone"):
    file: str; database: str; names: str
class NotOfTms(Reason,
    text="{file}: database {database} is none of TMS, for it has neither task nor parameter "
    "(there: {names}): give another archive"): file: str; database: str; names: tuple[str, ...]
class NoFieldIn(Reason, text="{file}: document {number} of {collection} has no {field}, so this is no database of TMS: "
    "give another archive"): file: str; number: int; collection: str; field: str
class ArchiveWrong(Reason, text="{file}: {why}"): file: str; why: Reason
class ArchiveWrongAt(Reason, text="{file}: {why} (byte {byte})"): file: str; why: Reason; byte: int
class NoArchive(Reason, text="is no archive of mongodump (wrong first bytes)", action=OTHER_ARCHIVE): pass
class ArchiveFormat(Reason, text="has archive format '{found}', this program reads {known}"): found: str; known: str
class ArchiveMisplaced(Reason, text="has documents of {collection} where none may be"): collection: str
class ArchiveChecksum(Reason, text="is damaged: the checksum of {collection} is another one"): collection: str
class ArchiveCut(Reason, text="ends before {collection} is complete: the file was cut off"): collection: str
class ArchiveNoName(Reason, text="names no collection where one must be named"): pass
class ArchiveDocument(Reason, text="is damaged: a document of {size} bytes"): size: int
class ArchiveMissing(Reason, text="is damaged: a document is missing"): pass
class ArchiveNoBson(Reason, text="is damaged: what should be a document is no BSON"): pass
class ArchivePacked(Reason, text="cannot be decompressed ({problem}): the file was cut off or damaged"): problem: str
class ArchiveEnds(Reason, text="ends in the middle: the file was cut off"): pass
class ArchiveNoRegular(Reason, text="is no regular file: give an archive"): pass
class ArchiveNoFile(Reason, text="there is no such file: give an archive"): pass
class ArchiveUnreadable(Reason, text="cannot be read ({problem})"): problem: str
