"""What this package is, and what it speaks: as proto/protocol.h says it for C++."""

VERSION = "0.1.0"

PROTOCOL_MAJOR = 1
PROTOCOL_MINOR = 0

# what Hello.feature can name
FEATURES = ("subscribe.filter", "subscribe.delivery", "subscribe.events", "replay", "device.move",
            "device.manage")

# bytes; the largest message that a client accepts
REPLY_LIMIT = 64 * 1024 * 1024
