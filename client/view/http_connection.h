#pragma once
// One browser's connection: gives it files until it asks for a WebSocket. io thread.

#include <memory>

#include "client/view/any_stream.h"
#include "client/view/web_settings.h"

namespace haptic::gateway {

/// Lives by itself until the browser or its time ends it, and holds the seat as long.
void serve_http(AnyStream stream, std::shared_ptr<WebShared> shared, Seat seat);

}  // namespace haptic::gateway
