#pragma once
// A WebSocket by Boost.Beast. io thread.

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <functional>
#include <memory>
#include <string>

#include "client/view/any_stream.h"
#include "client/view/web_settings.h"

namespace haptic::gateway {

/// Answers the request, which asks for a WebSocket and is granted one; `on_accepted` is called when it is
/// there, and never if the browser goes before. It holds the seats until it has ended.
void accept_socket(AnyStream stream,
                   const boost::beast::http::request<boost::beast::http::empty_body>& request,
                   const std::string& subprotocol, const WebSettings& settings, Seat connection, Seat socket,
                   std::function<void(std::shared_ptr<WebSocket>)> on_accepted);

}  // namespace haptic::gateway
