"""Messages on a byte stream: each is preceded by its length as a varint. As proto/framing.h; knows no sockets."""

from __future__ import annotations

# 2^35 - 1: more than any limit, and short enough that a broken stream is noticed soon
_LONGEST_VARINT = 5


class FramingError(Exception):
    """The stream is broken and cannot be read on."""


class FrameReader:
    """Cuts a stream that arrives in chunks of any size into messages.

    A length beyond `limit` (bytes) is refused before anything is reserved for it.
    """

    def __init__(self, limit: int) -> None:
        self._limit = limit
        self._buffer = bytearray()
        self._read = 0  # bytes of the buffer that were returned

    def append(self, chunk: bytes) -> None:
        """Takes the next bytes of the stream. Call next() until it returns None before calling this again."""
        del self._buffer[: self._read]
        self._read = 0
        self._buffer += chunk

    def next(self) -> bytes | None:
        """The next whole message, or None if more bytes are needed.

        Raises FramingError, and again in every later call, on a length that is too large or is not written in the
        shortest way.
        """
        length, begin = self._read_length()
        if begin == 0:
            return None
        if length > self._limit:
            raise FramingError(
                f"a message of {length} bytes is announced; at most {self._limit} are accepted")
        end = begin + length
        if len(self._buffer) < end:
            return None
        self._read = end
        return bytes(self._buffer[begin:end])

    def _read_length(self) -> tuple[int, int]:
        """The length, and where the message begins; 0 if the length is not there yet."""
        length = 0
        for i, byte in enumerate(self._buffer[self._read: self._read + _LONGEST_VARINT]):
            if i > 0 and byte == 0:
                raise FramingError("the length of a message is written with more bytes than it needs")
            length |= (byte & 0x7F) << (7 * i)
            if byte < 0x80:
                return length, self._read + i + 1
            if i + 1 == _LONGEST_VARINT:
                raise FramingError(
                    f"the length of a message is written with more than {_LONGEST_VARINT} bytes")
        return 0, 0


def frame(message: bytes) -> bytes:
    """The message with its length before it."""
    length, prefix = len(message), bytearray()
    while length >= 0x80:
        prefix.append(length & 0x7F | 0x80)
        length >>= 7
    prefix.append(length)
    return bytes(prefix) + message
