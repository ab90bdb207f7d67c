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

  /// A viewer at the other end of a WebSocket. At most two frames are sent without acknowledgement;
  /// of those that wait, only the newest is kept.
  class Viewer : public std::enable_shared_from_this<Viewer>
  {
  public:
    /// `connection` counts it among the connections while it lives.
    Viewer(Stream stream, Audience &audience, std::shared_ptr<void> connection);

    /// Completes the WebSocket handshake and joins the audience.
    void
    begin(const Request &request);

    void
    send_text(const std::string &text);

    /// Sends a binary message that, unlike frames, is never dropped.
    void
    send_binary(const Bytes &bytes);

    void
    send_frame(const Bytes &frame);

    /// Acknowledges frames up to this one. Frames are counted from 1; frames that were not sent are
    /// ignored.
    void
    acknowledge(unsigned int frame);

    /// Number of invalid messages so far.
    unsigned int n_mistakes = 0;

  private:
    /// A message to be sent.
    struct Message
    {
      Bytes bytes;
      bool  is_text;
    };

    void
    read_next();

    void
    write_next();

    /// Sends the newest frame, if there are not too many without acknowledgement.
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
    std::deque<Message>                     queue; ///< the first is being sent
    Bytes                                   waiting;
    std::deque<std::uint32_t>               under_way; ///< frames without acknowledgement
    bool                                    is_open = false, is_closing = false;
  };
} // namespace Exemplar::Live

#endif
