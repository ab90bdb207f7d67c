// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_server_h
#define exemplar_live_server_h

#include <exemplar/live/mailbox.h>
#include <exemplar/live/simulation.h>
#include <exemplar/live/site.h>

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>

#include <memory>
#include <set>
#include <string>

namespace Exemplar::Live
{
  class Viewer;

  /// Log for the user who started the server: printable lines, and no more than a few a second,
  /// whatever strangers do.
  class ServerLog
  {
  public:
    void
    refuse(const std::string &what);

  private:
    std::chrono::steady_clock::time_point second{};
    unsigned int                          n_lines = 0, n_silent = 0;
  };

  /// The viewers, and which of them has the mouse. Used in the thread of the network alone.
  class Audience
  {
  public:
    Audience(Mailbox &mailbox, ServerLog &log) : mailbox(mailbox), log(log) {}

    /// Sets the messages that each viewer gets first.
    void
    set_welcome(Welcome first)
    {
      welcome = std::move(first);
    }

    /// The same where the scene has become another one: viewers that are there get them, too.
    void
    welcome_again(Welcome other);

    /// The same where the scene has other obstacles: viewers that are there get `binaries`, which tell of these.
    void
    show_obstacles(Welcome other, const std::vector<Bytes> &binaries);

    /// Adds a viewer; false if there are as many as are allowed.
    bool
    join(const std::shared_ptr<Viewer> &viewer);

    void
    leave(Viewer *viewer);

    /// Closes all viewers at the end of the server.
    void
    dismiss();

    void
    show(const Bytes &frame);

    /// Sends a text to all viewers; a state also goes to those who come later.
    void
    tell(const std::string &text);

    /// Handles a message of a viewer; false if the viewer is to be closed for invalid messages.
    bool
    hear(Viewer *viewer, const std::string &message);

    ServerLog &
    get_log()
    {
      return log;
    }

  private:
    void
    send_welcome(Viewer &viewer) const;

    void
    give_mouse_to(Viewer *viewer);

    Mailbox                          &mailbox;
    ServerLog                        &log;
    Welcome                           welcome;
    Bytes                             newest; ///< newest frame; null: none yet
    std::set<std::shared_ptr<Viewer>> viewers;
    Viewer                           *holder = nullptr; ///< viewer that has the mouse
  };

  /// An address to listen at.
  struct ListenAt
  {
    std::string  address = "127.0.0.1"; ///< or unix:PATH
    unsigned int port    = 0;           ///< 0: any free one
  };

  /// The host name by which a browser addresses a server there; empty for a socket of the file
  /// system, for all addresses of the machine, and for an invalid address.
  std::string
  host_of(const ListenAt &place);

  /// The HTTP and WebSocket server; it admits requests that Access allows.
  class Server
  {
  public:
    /// Throws UserError if nobody can listen there.
    Server(const ListenAt &place, const Access &access, const Site &site, Audience &audience);

    ~Server();

    /// A line for the user: the address to open, or how to connect to it.
    std::string
    invitation() const;

    /// The event loop, to which other threads may post.
    boost::asio::io_context &
    get_context()
    {
      return context;
    }

    /// Runs until a signal ends it, or the context is stopped.
    void
    run();

  private:
    using Protocol = boost::asio::generic::stream_protocol;

    void
    listen(const ListenAt &place);

    void
    accept_next();

    boost::asio::io_context                      context;
    boost::asio::basic_socket_acceptor<Protocol> acceptor;
    boost::asio::signal_set                      signals; ///< signals to stop, from the beginning
    const Access                                &access;
    const Site                                  &site;
    Audience                                    &audience;
    std::string                                  socket_file; ///< removed at the end; may be empty
    std::string                                  host;        ///< name of the host in addresses
    unsigned int                                 port          = 0;
    std::shared_ptr<unsigned int>                n_connections = std::make_shared<unsigned int>(0);
  };
} // namespace Exemplar::Live

#endif
