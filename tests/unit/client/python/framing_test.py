"""Messages on a byte stream, as proto/framing.h cuts them."""

import random
import unittest
from pathlib import Path

from haptic.framing import FrameReader, FramingError, frame

CORPUS = Path(__file__).resolve().parents[3] / "fuzz" / "corpus" / "framing_fuzz"
LIMIT = 4096


def read(stream: bytes, chunk: int) -> tuple[list[bytes], bool]:
    """The messages in the stream, and whether it is broken."""
    messages, reader = [], FrameReader(LIMIT)
    try:
        for at in range(0, len(stream), chunk):
            reader.append(stream[at: at + chunk])
            while (message := reader.next()) is not None:
                messages.append(message)
    except FramingError:
        return messages, True
    return messages, False


class Framing(unittest.TestCase):
    def test_messages_come_back_whatever_the_chunks_are(self) -> None:
        messages = [b"hello", b"", b"x" * 127, b"y" * 128, b"z" * LIMIT]
        stream = b"".join(frame(message) for message in messages)
        for chunk in (1, 2, 3, 100, len(stream)):
            self.assertEqual(read(stream, chunk), (messages, False))

    def test_a_length_is_written_least_significant_bits_first(self) -> None:
        self.assertEqual(frame(b"a" * 300)[:2], bytes([0b10101100, 0b00000010]))

    def test_a_message_beyond_the_limit_is_refused_before_it_is_there(self) -> None:
        reader = FrameReader(LIMIT)
        reader.append(frame(b"a" * (LIMIT + 1))[:2])
        with self.assertRaisesRegex(FramingError, "4097 bytes is announced; at most 4096"):
            reader.next()

    def test_a_length_in_more_bytes_than_it_needs_is_refused(self) -> None:
        self.assertEqual(read(b"\x81\x00a", 3), ([], True))

    def test_a_length_that_does_not_end_is_refused(self) -> None:
        self.assertEqual(read(b"\xff\xff\xff\xff\xff", 5), ([], True))

    def test_a_broken_stream_stays_broken(self) -> None:
        reader = FrameReader(LIMIT)
        reader.append(b"\x80\x00")
        for _ in range(2):
            with self.assertRaises(FramingError):
                reader.next()

    def test_what_the_fuzzer_kept_is_read_the_same_in_all_chunks(self) -> None:
        inputs = sorted(CORPUS.iterdir())
        self.assertTrue(inputs)
        for file in inputs:
            stream = file.read_bytes()[1:]
            whole = read(stream, max(1, len(stream)))
            for chunk in (1, 7, 64):
                self.assertEqual(read(stream, chunk), whole, file.name)

    def test_noise_ends_in_messages_or_in_an_error(self) -> None:
        noise = random.Random(1)
        for _ in range(500):
            stream = noise.randbytes(noise.randrange(200))
            messages, _ = read(stream, 9)
            self.assertTrue(all(len(message) <= LIMIT for message in messages))


if __name__ == "__main__":
    unittest.main()
