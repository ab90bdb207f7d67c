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

  /// Lines for the one who has started the server, printable, and not more than some a second, whatever
  /// strangers do.
  class ServerLog
  {
  public:
    void
    refuse(const std::string &what);

  private:
    std::chrono::steady_clock::time_point second{};
    unsigned int                          n_lines = 0, n_silent = 0;
  };

  /// Who looks, and who of them has the mouse. All in the thread of the network.
  class Audience
  {
  public:
    Audience(Mailbox &mailbox, ServerLog &log) : mailbox(mailbox), log(log) {}

    /// What each viewer gets first.
    void
    set_welcome(Welcome first)
    {
      welcome = std::move(first);
    }

    /// False if there are as many as may be.
    bool
    join(const std::shared_ptr<Viewer> &viewer);

    void
    leave(Viewer *viewer);

    /// The server ends: nobody looks any more.
    void
    dismiss();

    void
    show(const Bytes &frame);

    /// All of them; a state also those who come later.
    void
    tell(const std::string &text);

    /// A viewer has sent this message; false if it is to be sent away for its messages.
    bool
    hear(Viewer *viewer, const std::string &message);

    ServerLog &
    get_log()
    {
      return log;
    }

  private:
    void
    give_mouse_to(Viewer *viewer);

    Mailbox                          &mailbox;
    ServerLog                        &log;
    Welcome                           welcome;
    Bytes                             newest; ///< frame; null: there was none
    std::set<std::shared_ptr<Viewer>> viewers;
    Viewer                           *holder = nullptr; ///< of the mouse
  };

  /// Where to listen.
  struct ListenAt
  {
    std::string  address = "127.0.0.1"; ///< or unix:PATH
    unsigned int port    = 0;           ///< 0: one that is free
  };

  /// The name by which a browser asks who listens there; empty for a socket of the file system, for all addresses of the
  /// machine, and for what is no address.
  std::string
  host_of(const ListenAt &place);

  /// Listens, and lets in those whom Access knows.
  class Server
  {
  public:
    /// Throws UserError if nobody can listen there.
    Server(const ListenAt &place, const Access &access, const Site &site, Audience &audience);

    ~Server();

    /// What to open, or what to do before.
    std::string
    invitation() const;

    /// What other threads post to.
    boost::asio::io_context &
    get_context()
    {
      return context;
    }

    /// Until a signal ends it, or the context is stopped.
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
    boost::asio::signal_set                      signals; ///< that end it, from the beginning on
    const Access                                &access;
    const Site                                  &site;
    Audience                                    &audience;
    std::string                   socket_file; ///< to remove at the end; may be empty
    std::string                   host;        ///< to be asked for; of an address
    unsigned int                  port          = 0;
    std::shared_ptr<unsigned int> n_connections = std::make_shared<unsigned int>(0);
  };
} // namespace Exemplar::Live

#endif
