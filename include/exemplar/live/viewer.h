// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_viewer_h
#define exemplar_live_viewer_h

#include <exemplar/live/server.h>

#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>

#include <deque>

namespace Exemplar::Live
{
  using Stream = boost::beast::basic_stream<boost::asio::generic::stream_protocol>;

  /// One that looks, at the other end of a WebSocket. Frames wait for its acknowledgements, two under way,
  /// and only the newest waits.
  class Viewer : public std::enable_shared_from_this<Viewer>
  {
  public:
    /// `connection` counts it as long as it lives.
    Viewer(Stream stream, Audience &audience, std::shared_ptr<void> connection);

    /// Shake hands, and join the audience.
    void
    begin(const Request &request);

    void
    send_text(const std::string &text);

    /// Of these none is left out.
    void
    send_binary(const Bytes &bytes);

    void
    send_frame(const Bytes &frame);

    /// The newest frame that it has. Frames are counted from 1; what it says of none is ignored.
    void
    acknowledge(unsigned int frame);

    /// Messages that were none so far.
    unsigned int n_mistakes = 0;

  private:
    /// What is to be sent.
    struct Message
    {
      Bytes bytes;
      bool  is_text;
    };

    void
    read_next();

    void
    write_next();

    /// The newest frame, if it may go on its way.
    void
    offer_frame();

    void
    close(boost::beast::websocket::close_code reason);

    void
    end();

    boost::beast::websocket::stream<Stream> socket;
    Audience                               &audience;
    std::shared_ptr<void>                   connection;
    boost::beast::flat_buffer               buffer;
    std::deque<Message>                     queue; ///< the first is under way
    Bytes                                   waiting;
    std::deque<std::uint32_t>               under_way; ///< numbers of frames
    bool                                    is_open = false, is_closing = false;
  };
} // namespace Exemplar::Live

#endif
