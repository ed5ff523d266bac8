"""Guesses cost time by account and address, and lock nobody else out; hashing has a short queue."""

import threading

import anyio
import pytest

from tms_reason.errors import TmsError
from tms_ur.callers import caller
from tms_ur.hashing import MAX_OF_ONE, MAX_WAITING, Hashing
from tms_ur.login_throttle import ACCOUNT, ADDRESS, MAX_KEYS, PAIR, LoginThrottle
from tms_ur.reasons import Throttled


class Clock:
    now = 0.0

    def __call__(self) -> float:
        return self.now


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def throttle(clock: Clock) -> LoginThrottle:
    return LoginThrottle(clock)


def guesses(throttle: LoginThrottle, clock: Clock, seconds: int, *pairs: tuple[str, str], every: int = 1) -> int:
    """How many guesses come through if each pair tries again and again, `every` so many seconds."""
    through = 0
    for _ in range(0, seconds, every):
        clock.now += every
        for account, address in pairs:
            try:
                throttle.attempt(account, address)
                through += 1
            except TmsError:
                continue
    return through


def test_one_pair(throttle: LoginThrottle, clock: Clock) -> None:
    assert guesses(throttle, clock, 3600, ("ken", "192.0.2.1")) < PAIR.free + 70
    with pytest.raises(TmsError) as error:
        throttle.attempt("ken", "192.0.2.1")
    assert isinstance(error.value.reason, Throttled)


def test_the_wait_is_bounded_and_forgotten(throttle: LoginThrottle, clock: Clock) -> None:
    guesses(throttle, clock, 3600, ("ken", "192.0.2.1"))
    clock.now += PAIR.longest
    throttle.attempt("ken", "192.0.2.1")
    clock.now += 1000
    assert guesses(throttle, clock, 3, ("ken", "192.0.2.1")) == 3


def test_many_accounts_from_one_address(throttle: LoginThrottle, clock: Clock) -> None:
    pairs = [(f"user{number}", "192.0.2.1") for number in range(500)]
    assert guesses(throttle, clock, 600, *pairs, every=5) < ADDRESS.free + 600 / ADDRESS.longest + 10


def test_one_account_from_many_addresses(throttle: LoginThrottle, clock: Clock) -> None:
    pairs = [("ken", f"192.0.{number // 250}.{number % 250}") for number in range(500)]
    assert guesses(throttle, clock, 600, *pairs, every=5) < ACCOUNT.free + 600 / ACCOUNT.longest + 10


def test_somebody_elses_guesses_keep_nobody_out_for_long(throttle: LoginThrottle, clock: Clock) -> None:
    pairs = [("ken", f"192.0.2.{number}") for number in range(1, 200)]
    throttle.attempt("ken", "198.51.100.1")
    throttle.right("ken", "198.51.100.1")
    guesses(throttle, clock, 600, *pairs, every=5)
    throttle.attempt("ken", "198.51.100.1")  # where he has logged in before: at once
    clock.now += ACCOUNT.longest
    throttle.attempt("ken", "203.0.113.1")  # from a new place after some seconds


def test_a_guesser_behind_the_same_address_keeps_out_nobody_who_was_in(throttle: LoginThrottle, clock: Clock) -> None:
    throttle.attempt("mina", "192.0.2.1")
    throttle.right("mina", "192.0.2.1")
    guesses(throttle, clock, 600, *[(f"user{number}", "192.0.2.1") for number in range(100)])
    throttle.attempt("mina", "192.0.2.1")


def test_right_passwords_clear_nothing_of_others(throttle: LoginThrottle, clock: Clock) -> None:
    """Whoever has an account must not get free guesses at others by logging in between."""
    through = 0
    for number in range(200):
        clock.now += 1.0
        throttle.attempt("mina", "192.0.2.1")
        throttle.right("mina", "192.0.2.1")
        through += _try(throttle, f"user{number}", "192.0.2.1")
    assert through < ADDRESS.free + 20


def _try(throttle: LoginThrottle, account: str, address: str) -> int:
    try:
        throttle.attempt(account, address)
    except TmsError:
        return 0
    return 1


def test_tries_at_the_same_time_are_not_free(throttle: LoginThrottle) -> None:
    through = sum(_try(throttle, "ken", "192.0.2.1") for _ in range(100))  # none of them is known to be wrong yet
    assert through == PAIR.free + 1


def test_memory_is_bounded(throttle: LoginThrottle) -> None:
    for number in range(3 * MAX_KEYS):
        _try(throttle, "x" * 10_000 + str(number), f"2001:db8:{number:x}::1")
    for counts in (throttle._pairs, throttle._addresses, throttle._accounts):
        assert len(counts._counts) <= MAX_KEYS
        assert max(map(len, counts._counts)) < 200


@pytest.mark.parametrize(
    ("address", "counted"),
    [("192.0.2.1", "192.0.2.1"), ("::ffff:192.0.2.1", "192.0.2.1"), ("2001:db8:1:2:3::4", "2001:db8:1:2::/64"),
     ("-", "-")],
)  # fmt: skip
def test_callers(address: str, counted: str) -> None:
    assert caller(address) == counted


def test_hashing_has_a_short_queue_with_room_for_everybody() -> None:
    async def story() -> None:
        hashing, release, done = Hashing(), threading.Event(), []

        async def verify(address: str, stop: bool = False) -> None:
            done.append(await hashing.run(address, lambda: release.wait(30) and address, stop))

        async with anyio.create_task_group() as group:
            for number in range(MAX_WAITING // MAX_OF_ONE):
                for _ in range(MAX_OF_ONE):
                    group.start_soon(verify, f"192.0.2.{number}")
                await anyio.wait_all_tasks_blocked()
                if number == 0:
                    with pytest.raises(TmsError, match="being checked") as one_too_many:
                        await verify("192.0.2.0")
                    assert one_too_many.value.code == "MANY_LOGINS"
            with pytest.raises(TmsError, match="being checked"):
                await verify("198.51.100.1")
            stop = anyio.Event()

            async def press() -> None:
                await hashing.run("198.51.100.1", lambda: None, stop=True)  # while all others hang
                stop.set()

            group.start_soon(press)
            with anyio.fail_after(30):
                await stop.wait()
            assert done == []
            release.set()
        assert len(done) == MAX_WAITING
        await verify("192.0.2.0")

    anyio.run(story)
