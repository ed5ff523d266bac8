"""Users and their roles: the users file, passwords and tokens as argon2 hashes, and sessions."""

import hashlib
import secrets
import stat
import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from argon2 import PasswordHasher
from argon2.exceptions import InvalidHashError, VerificationError
from pydantic import Field, model_validator

from tms_config.clock import monotonic
from tms_config.models import Settings
from tms_config.yaml_file import parse
from tms_reason.errors import ConfigError, TmsError
from tms_reason.names import Name
from tms_ur.login_throttle import LoginThrottle
from tms_ur.reasons import Login, NoUsersFile, UnreadableUsers, UsersForAll, WrongPassword

RoleName = Literal["viewer", "operator", "admin"]
RANK: dict[RoleName, int] = {"viewer": 0, "operator": 1, "admin": 2}
HASHER = PasswordHasher(time_cost=2, memory_cost=19_456, parallelism=1)  # OWASP's minimum: a site PC has other work
SESSION_IDLE = 12 * 3600.0  # s: one shift
MAX_SESSIONS = 500


class User(Settings):
    """One person or program."""

    role: RoleName
    password: str | None = Field(default=None, pattern=r"^\$argon2id\$")  # hash
    token: str | None = Field(default=None, pattern=r"^\$argon2id\$")  # hash

    @model_validator(mode="after")
    def _some_way_in(self) -> "User":
        if self.password is None and self.token is None:
            raise ValueError("needs a password or a token: `tms user add`")
        return self


class Users(Settings):
    """The file that `tms user` writes."""

    users: dict[Name, User] = Field(default_factory=dict)


@dataclass(frozen=True)
class Person:
    """The person or program that sends a request."""

    name: str
    role: RoleName

    def may(self, role: RoleName) -> bool:
        return RANK[self.role] >= RANK[role]


class Access:
    """Users, sessions and verified tokens; thread safe."""

    def __init__(self, file: Path | None, clock: Callable[[], float] = monotonic) -> None:
        """Read the users.

        Raises:
            ConfigError: the file cannot be read, is wrong, or is readable by other users.
        """
        self.asks = file is not None
        self._users: dict[str, User] = {} if file is None else read_users(file)
        self._clock = clock
        self._throttle = LoginThrottle(clock)
        self._decoy = hashed(secrets.token_urlsafe()) if self.asks else ""
        self._sessions: OrderedDict[str, tuple[Person, float]] = OrderedDict()  # key's digest -> person, last use [s]
        self._tokens: OrderedDict[str, Person] = OrderedDict()  # digest of a token that was verified
        self._lock = threading.Lock()

    def login(self, name: str, password: str, source: str) -> tuple[str, Person]:
        """Check a password and begin a session; returns the session's key and the person.

        Raises:
            TmsError: LOGIN, or THROTTLED.
        """
        user = self._users.get(name)
        person = self._verified(name, user, user.password if user else None, password, source)
        key = secrets.token_urlsafe(32)
        with self._lock:
            self._sessions[_digest(key)] = (person, self._clock())
            while len(self._sessions) > MAX_SESSIONS:
                self._sessions.popitem(last=False)
        return key, person

    def logout(self, key: str) -> None:
        with self._lock:
            self._sessions.pop(_digest(key), None)

    def session(self, key: str) -> Person | None:
        """The person of a session, None if it is over; every use prolongs it."""
        digest = _digest(key)
        with self._lock:
            person, used = self._sessions.pop(digest, (None, 0.0))
            if person is None or self._clock() - used > SESSION_IDLE:
                return None
            self._sessions[digest] = (person, self._clock())
            return person

    def known_token(self, text: str) -> Person | None:
        """The person of a token that was verified before, else None; quick."""
        with self._lock:
            return self._tokens.get(_digest(text))

    def token(self, text: str, source: str) -> Person:
        """Verify a token `name:secret` and return its person; slow.

        Raises:
            TmsError: LOGIN, or THROTTLED.
        """
        name, _, secret = text.partition(":")
        user = self._users.get(name)
        person = self._verified(name, user, user.token if user else None, secret, source)
        with self._lock:
            self._tokens[_digest(text)] = person
            while len(self._tokens) > MAX_SESSIONS:
                self._tokens.popitem(last=False)
        return person

    def _verified(self, name: str, user: User | None, kept: str | None, secret: str, source: str) -> Person:
        self._throttle.attempt(name, source)
        right = _matches(kept or self._decoy, secret)  # an unknown name takes as long as a known one
        if not right or user is None or kept is None:
            raise TmsError(Login(WrongPassword()))
        self._throttle.right(name, source)
        return Person(name, user.role)


def hashed(secret: str) -> str:
    """The hash of a password or token for the users file."""
    return HASHER.hash(secret)


def _matches(kept: str, secret: str) -> bool:
    try:
        return HASHER.verify(kept, secret)
    except (VerificationError, InvalidHashError):
        return False


def _digest(key: str) -> str:
    return hashlib.sha256(key.encode()).hexdigest()


def read_users(file: Path) -> dict[str, User]:
    """Read a users file, which other users of the PC must not be able to read.

    Raises:
        ConfigError: it cannot be read, is wrong, or is readable by other users.
    """
    try:
        mode = file.stat().st_mode
    except FileNotFoundError as error:
        raise ConfigError(NoUsersFile(str(file))) from error
    except OSError as error:
        raise ConfigError(UnreadableUsers(str(file), str(error.strerror))) from error
    if stat.S_ISREG(mode) and mode & 0o007:
        raise ConfigError(UsersForAll(str(file)))
    return parse(file, Users).users
