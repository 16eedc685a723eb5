"""The messages of the schema (proto/haptic/v1), as protoc makes them: `v1.Scene`, `v1.Request`, ..."""

from haptic.v1.config_pb2 import *  # noqa: F401,F403
from haptic.v1.control_pb2 import *  # noqa: F401,F403
from haptic.v1.device_pb2 import *  # noqa: F401,F403
from haptic.v1.geometry_pb2 import *  # noqa: F401,F403
from haptic.v1.scene_pb2 import *  # noqa: F401,F403
from haptic.v1.state_pb2 import *  # noqa: F401,F403
from haptic.v1.telemetry_pb2 import *  # noqa: F401,F403
