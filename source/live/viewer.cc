// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/viewer.h>

#include <cstring>

namespace Exemplar::Live
{
  namespace beast     = boost::beast;
  namespace websocket = beast::websocket;

  namespace
  {
    constexpr std::size_t max_message = 65536, max_queue = 200, max_under_way = 2;

    std::uint32_t
    number_of(const Bytes &frame)
    {
      std::uint32_t number = 0;
      std::memcpy(&number, frame->data() + sizeof(number), sizeof(number));
      return number;
    }
  } // namespace

  Viewer::Viewer(Stream stream, Audience &audience, std::shared_ptr<void> connection)
      : socket(std::move(stream)), audience(audience), connection(std::move(connection))
  {
    beast::get_lowest_layer(socket).expires_never(); // the WebSocket has its own timeouts
    auto times              = websocket::stream_base::timeout::suggested(beast::role_type::server);
    times.handshake_timeout = std::chrono::seconds(10);
    times.idle_timeout      = std::chrono::seconds(60);
    socket.set_option(times);
    socket.read_message_max(max_message);
    socket.auto_fragment(false);
  }

  void
  Viewer::begin(const Request &request)
  {
    socket.async_accept(request,
                        [self = shared_from_this()](const beast::error_code error)
                        {
                          if (error)
                            return;
                          self->is_open = true;
                          if (self->audience.join(self))
                            self->read_next();
                          else
                            self->close(websocket::close_code::try_again_later);
                        });
  }

  void
  Viewer::read_next()
  {
    buffer.clear();
    socket.async_read(
        buffer,
        [self = shared_from_this()](const beast::error_code error, std::size_t)
        {
          if (error == websocket::error::message_too_big
              || error == websocket::error::buffer_overflow)
            self->audience.get_log().refuse("a message of more than 64 kB");
          if (error)
            return self->end();
          if (self->is_closing)
            return self->read_next(); // until the other side has closed, too
          if (!self->socket.got_text())
          {
            self->audience.get_log().refuse("a message that is no text");
            self->close(websocket::close_code::unknown_data);
          }
          else if (!self->audience.hear(self.get(), beast::buffers_to_string(self->buffer.data())))
            self->close(websocket::close_code::policy_error);
          self->read_next();
        });
  }

  void
  Viewer::send_text(const std::string &text)
  {
    if (!is_open || is_closing)
      return;
    if (queue.size() >= max_queue) // the other side does not read
    {
      audience.get_log().refuse("a viewer that does not read");
      return end();
    }
    queue.push_back({ std::make_shared<const std::string>(text), true });
    if (queue.size() == 1)
      write_next();
  }

  void
  Viewer::send_binary(const Bytes &bytes)
  {
    if (!is_open || is_closing)
      return;
    queue.push_back({ bytes, false });
    if (queue.size() == 1)
      write_next();
  }

  void
  Viewer::send_frame(const Bytes &frame)
  {
    waiting = frame;
    offer_frame();
  }

  void
  Viewer::offer_frame()
  {
    if (waiting == nullptr || under_way.size() >= max_under_way)
      return;
    under_way.push_back(number_of(waiting));
    send_binary(waiting);
    waiting.reset();
  }

  void
  Viewer::acknowledge(const unsigned int frame)
  {
    while (!under_way.empty() && under_way.front() <= frame)
      under_way.pop_front();
    offer_frame();
  }

  void
  Viewer::write_next()
  {
    const Message &message = queue.front();
    socket.text(message.is_text);
    socket.async_write(boost::asio::buffer(*message.bytes),
                       [self = shared_from_this()](const beast::error_code error, std::size_t)
                       {
                         if (error)
                           return self->end();
                         self->queue.pop_front();
                         if (!self->queue.empty() && !self->is_closing)
                           self->write_next();
                       });
  }

  void
  Viewer::close(const websocket::close_code reason)
  {
    if (is_closing)
      return;
    is_closing = true;
    socket.async_close(reason,
                       [self = shared_from_this()](const beast::error_code) { self->end(); });
  }

  void
  Viewer::end()
  {
    if (!is_open)
      return;
    is_open = false;
    beast::error_code ignored;
    beast::get_lowest_layer(socket).socket().close(ignored);
    audience.leave(this);
  }
} // namespace Exemplar::Live
