"""The checksum that mongodump writes after each collection: CRC-64/ECMA as Go has it, which is the one of xz."""

POLYNOMIAL = 0xC96C5795D7870F42  # bits reversed
ALL = 2**64 - 1


class Crc64:
    """Takes bytes in pieces; two bytes a step, which is what makes it fast enough in Python (about 10 MB/s)."""

    def __init__(self) -> None:
        self._table = _two_byte_table()
        self._crc = ALL
        self._odd = b""  # a last byte without a partner

    def update(self, data: bytes) -> None:
        data = self._odd + data
        even = len(data) & ~1
        self._odd = data[even:]
        crc, table = self._crc, self._table
        for pair in memoryview(data)[:even].cast("H"):  # little-endian, as every PC that ROS 2 has wheels for
            crc = table[(crc ^ pair) & 0xFFFF] ^ crc >> 16
        self._crc = crc

    def signed(self) -> int:
        """The sum so far as the signed 64-bit number that BSON holds."""
        crc = self._crc
        for byte in self._odd:
            crc = _step(crc ^ byte, 8)
        crc ^= ALL
        return crc - 2**64 if crc >> 63 else crc


_TABLE: list[int] = []  # filled when it is first needed: 65,536 numbers


def _two_byte_table() -> list[int]:
    if not _TABLE:
        single = [_step(byte, 8) for byte in range(256)]
        _TABLE.extend(single[(single[n & 255] ^ n >> 8) & 255] ^ single[n & 255] >> 8 for n in range(65536))
    return _TABLE


def _step(crc: int, bits: int) -> int:
    for _ in range(bits):
        crc = crc >> 1 ^ (POLYNOMIAL if crc & 1 else 0)
    return crc
