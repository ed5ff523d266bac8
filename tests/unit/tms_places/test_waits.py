"""Who waits for whom, and whose orders of holds may lead to that."""

from tms_places.claims import Book, Claim, Request
from tms_places.waits import Step, circles, crossing, orders, waiting_for


def claim(machine: str) -> Claim:
    return Claim(machine, frozenset({"r"}), 0.0)


def request(machine: str, *places: str) -> Request:
    return Request(machine, "r", places, 0.0)


def test_machines_wait_for_holders_and_for_those_who_came_first() -> None:
    book = Book(claims={"p": claim("a")}, queue=(request("b", "p"), request("c", "p"), request("a", "q")))
    assert waiting_for(book) == {"a": set(), "b": {"a"}, "c": {"a", "b"}}


def test_nobody_waits_for_those_who_want_what_it_holds() -> None:
    book = Book(claims={"p": claim("a"), "q": claim("b")}, queue=(request("b", "p"), request("a", "p", "s")))
    assert waiting_for(book) == {"a": set(), "b": {"a"}}


def test_a_circle_is_found_once() -> None:
    book = Book(
        claims={"p": claim("a"), "q": claim("b"), "s": claim("c")},
        queue=(request("b", "p"), request("c", "q"), request("a", "s"), request("d", "p")),
    )
    assert circles(waiting_for(book)) == [("a", "c", "b")]


def test_a_queue_is_no_circle() -> None:
    book = Book(claims={"p": claim("a")}, queue=(request("b", "p"), request("c", "p")))
    assert circles(waiting_for(book)) == []


def test_two_circles_through_one_machine() -> None:
    assert circles({"a": ["b", "c"], "b": ["a"], "c": ["a"]}) == [("a", "b"), ("a", "c")]


def test_orders_of_a_tree() -> None:
    steps = [
        Step("a", "p", True), Step("a", "q", True), Step("a", "p", False), Step("a", "s", True),
        Step("b", "s", True), Step("b", "p", True),
    ]  # fmt: skip
    assert orders(steps) == {"a": {("p", "q"), ("q", "s")}, "b": {("s", "p")}}


def test_orders_that_cross_are_told_with_who_takes_what() -> None:
    assert crossing({"a": {("p", "q")}, "b": {("q", "p")}}) == [(("a", "p", "q"), ("b", "q", "p"))]
    three = crossing({"a": {("p", "q")}, "b": {("q", "s")}, "c": {("s", "p")}})
    assert three == [(("a", "p", "q"), ("b", "q", "s"), ("c", "s", "p"))]


def test_the_same_order_or_one_machine_alone_is_no_circle() -> None:
    assert crossing({"a": {("p", "q")}, "b": {("p", "q")}}) == []
    assert crossing({"a": {("p", "q"), ("q", "p")}}) == []
    assert crossing({"a": {("p", "q"), ("q", "s")}, "b": {("s", "p")}}) == []
