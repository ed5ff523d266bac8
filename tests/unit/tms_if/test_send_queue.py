"""What waits for a slow client is bounded, and only messages of topics give way."""

from tms_if.send_queue import SendQueue


def test_order_and_end() -> None:
    box = SendQueue()
    assert box.put(b"1") and box.put(b"2", droppable=True)
    assert [box.take(), box.take()] == [b"1", b"2"]
    box.close()
    assert box.take() is None
    assert box.put(b"3")  # to nobody
    assert box.dropped == 0


def test_the_oldest_message_gives_way_but_no_answer() -> None:
    box = SendQueue(frames=3)
    box.put(b"answer")
    for word in (b"a", b"b", b"c"):
        assert box.put(word, droppable=True)
    assert box.dropped == 1
    assert [box.take(), box.take(), box.take()] == [b"answer", b"b", b"c"]


def test_answers_alone_fill_it() -> None:
    box = SendQueue(frames=2)
    assert box.put(b"1") and box.put(b"2")
    assert not box.put(b"3")
    assert box.put(b"lost", droppable=True)
    assert box.dropped == 2


def test_its_size_is_bounded_too() -> None:
    box = SendQueue(size=100)
    for _ in range(10):
        assert box.put(bytes(40), droppable=True)
    assert box.dropped == 8
    assert box.put(bytes(500), droppable=True)  # one that is larger than the box goes alone
    assert box.take() == bytes(500)
