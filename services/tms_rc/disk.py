"""Keeps notes and receipts on the disk, one after the other in a thread of its own, and answers with events."""

from queue import SimpleQueue

from prometheus_client import Counter

from tms_decision.gateway.effects import KeepDriver, KeepReceipt, KeepState
from tms_decision.gateway.events import NoteKept, ReceiptKept
from tms_rc.latch_file import LatchFile
from tms_rc.reasons import DriverNotKept, StateNotKept
from tms_rc.receipts import Receipts
from tms_rc.shell import Shell
from tms_rc.stop_receipt import message_of
from tms_ros.packing import pack
from tms_runtime.app import App

UNKEPT = Counter("tms_rc_notes_lost_total", "Latches and receipts that could not be kept on the disk")

Kept = KeepState | KeepDriver | KeepReceipt


class Disk:
    """The gateway's notes and receipts."""

    def __init__(self, app: App, shell: Shell, notes: LatchFile, receipts: Receipts) -> None:
        self._app, self._shell, self._notes, self._receipts = app, shell, notes, receipts
        self._waiting: SimpleQueue[Kept] = SimpleQueue()  # as many as there are stops and goals at the same time
        shell.does(KeepState, self._waiting.put)
        shell.does(KeepDriver, self._waiting.put)
        shell.does(KeepReceipt, self._waiting.put)
        app.ros.loop.begin(self._work, "disk")

    def _work(self) -> None:
        while True:
            wanted = self._waiting.get()
            if isinstance(wanted, KeepReceipt):
                self._keep_receipt(wanted)
            else:
                self._keep_note(wanted)

    def _keep_note(self, wanted: KeepState | KeepDriver) -> None:
        problem = None
        try:
            if isinstance(wanted, KeepDriver):
                self._notes.take(wanted.who)
            elif wanted.latched is not None:
                self._notes.latch(wanted.latched)
            else:
                self._notes.arm(wanted.holder, wanted.run)
        except OSError as error:
            UNKEPT.inc()
            self._app.log.error("note_not_kept", reason=str(error))
            kind = DriverNotKept if isinstance(wanted, KeepDriver) else StateNotKept
            problem = kind(str(error.strerror))
        self._shell.happened(NoteKept(wanted.number, problem))

    def _keep_receipt(self, wanted: KeepReceipt) -> None:
        problem = ""
        try:
            self._receipts.keep(pack(message_of(wanted.receipt, self._app.machine)))
        except OSError as error:
            UNKEPT.inc()
            problem = str(error.strerror)
        self._shell.happened(ReceiptKept(wanted.stop, problem))
