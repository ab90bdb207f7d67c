// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/live/server.h>
#include <exemplar/live/viewer.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/steady_timer.hpp>

#include <fmt/core.h>

#include <csignal>
#include <cstring>
#include <filesystem>
#include <optional>
#include <sys/stat.h>
#include <unistd.h>

namespace Exemplar::Live
{
  namespace asio  = boost::asio;
  namespace beast = boost::beast;
  namespace http  = beast::http;

  namespace
  {
    constexpr unsigned int max_connections = 64, max_requests = 200;
    constexpr auto max_wait = std::chrono::seconds(10); ///< for a request or a part of an answer

    /// An HTTP connection, until it closes or becomes a viewer.
    class Connection : public std::enable_shared_from_this<Connection>
    {
    public:
      Connection(Stream                stream,
                 const Access         &access,
                 const Site           &site,
                 Audience             &audience,
                 std::shared_ptr<void> count)
          : stream(std::move(stream)), access(access), site(site), audience(audience),
            count(std::move(count))
      {
      }

      void
      read_next()
      {
        parser.emplace();
        parser->header_limit(8192);
        parser->body_limit(1024);
        stream.expires_after(max_wait);
        http::async_read(
            stream, buffer, *parser,
            [self = shared_from_this()](const beast::error_code error, std::size_t)
            {
              if (!error)
                self->take(self->parser->release());
              else if (error != http::error::end_of_stream
                       && error.category()
                              == http::make_error_code(http::error::bad_method).category())
                self->audience.get_log().refuse("what is no request: " + error.message());
            });
      }

    private:
      void
      take(Request request)
      {
        const std::string objection = objection_to(request, access);
        if (!objection.empty())
          audience.get_log().refuse(objection);
        const bool is_socket = site.has_socket() && request.target() == "/ws"
                               && beast::websocket::is_upgrade(request);
        if (objection.empty() && is_socket)
        {
          std::make_shared<Viewer>(std::move(stream), audience, count)->begin(request);
          return;
        }
        response = answer(request, access, site, objection);
        if (++n_requests == max_requests)
          response.keep_alive(false);
        serializer.emplace(response);
        write_next();
      }

      /// Sends a part at a time, with a time limit for each, as a slow line may take long for all.
      void
      write_next()
      {
        stream.expires_after(max_wait);
        http::async_write_some(
            stream, *serializer,
            [self = shared_from_this()](const beast::error_code error, std::size_t)
            {
              if (!error && !self->serializer->is_done())
                self->write_next();
              else if (!error && self->response.keep_alive())
                self->read_next();
            });
      }

      Stream                                                      stream;
      const Access                                               &access;
      const Site                                                 &site;
      Audience                                                   &audience;
      std::shared_ptr<void>                                       count;
      beast::flat_buffer                                          buffer{ 16384 };
      std::optional<http::request_parser<http::string_body>>      parser;
      Response                                                    response;
      std::optional<http::response_serializer<http::string_body>> serializer; ///< of the response
      unsigned int                                                n_requests = 0;
    };

    /// A token that is counted while it lives.
    std::shared_ptr<void>
    counted(const std::shared_ptr<unsigned int> &count)
    {
      ++*count;
      return { nullptr, [count](void *) { --*count; } };
    }

    const std::string unix_prefix = "unix:";

    /// Whether a socket of the file system was left by a killed server: nobody listens there.
    bool
    is_left_over(const std::string &path)
    {
      const asio::local::stream_protocol::endpoint endpoint(path);
      asio::io_context                             context;
      asio::local::stream_protocol::socket         socket(context, endpoint.protocol());
      socket.non_blocking(true); // a full queue answers at once, too
      beast::error_code error;
      socket.connect(endpoint, error);
      return error == asio::error::connection_refused;
    }
  } // namespace

  std::string
  host_of(const ListenAt &place)
  {
    beast::error_code none;
    const auto        address = asio::ip::make_address(place.address, none);
    if (none || address.is_unspecified())
      return "";
    return address.is_v6() ? "[" + address.to_string() + "]" : address.to_string();
  }

  Server::Server(const ListenAt &place, const Access &access, const Site &site, Audience &audience)
      : acceptor(context), signals(context, SIGINT, SIGTERM, SIGHUP), access(access), site(site),
        audience(audience)
  {
    signals.async_wait(
        [this](const beast::error_code error, int)
        {
          if (!error)
            context.stop();
        });
    try
    {
      listen(place);
    }
    catch (const boost::system::system_error &error)
    {
      throw UserError(
          fmt::format("Nobody can listen at {}, port {}: {}. Give another --port or --bind; "
                      "--port 0 takes one that is free.",
                      place.address, place.port, error.code().message()));
    }
    accept_next();
  }

  Server::~Server()
  {
    if (!socket_file.empty())
      unlink(socket_file.c_str());
  }

  void
  Server::listen(const ListenAt &place)
  {
    if (place.address.compare(0, unix_prefix.size(), unix_prefix) == 0)
    {
      const std::string path = place.address.substr(unix_prefix.size());
      if (path.empty() || path.size() > 100)
        throw UserError("--bind unix:PATH takes a path of at most 100 characters.");
      const auto kind = std::filesystem::symlink_status(path).type();
      if (kind != std::filesystem::file_type::not_found
          && kind != std::filesystem::file_type::socket)
        throw UserError("--bind unix:" + path + ": this is a file. Give another name.");
      if (kind == std::filesystem::file_type::socket && !is_left_over(path))
        throw UserError("--bind unix:" + path
                        + ": another server listens there. End it, or give another name.");
      const asio::local::stream_protocol::endpoint endpoint(path);
      unlink(path.c_str());
      acceptor.open(endpoint.protocol());
      const mode_t before = umask(0177); // access for the owner alone
      acceptor.bind(endpoint);
      umask(before);
      socket_file = path;
    }
    else
    {
      beast::error_code             no_address;
      const asio::ip::tcp::endpoint endpoint(asio::ip::make_address(place.address, no_address),
                                             static_cast<unsigned short>(place.port));
      if (no_address)
        throw UserError("--bind: " + in_quotes(place.address)
                        + " is no address of numbers. Allowed: 127.0.0.1 for this machine alone, "
                          "0.0.0.0 for all that "
                          "reach it, another of its addresses, or unix:PATH.");
      acceptor.open(endpoint.protocol());
      acceptor.set_option(asio::socket_base::reuse_address(true));
      acceptor.bind(endpoint);
      asio::ip::tcp::endpoint bound;
      const auto              generic = acceptor.local_endpoint();
      std::memcpy(bound.data(), generic.data(), generic.size());
      port = bound.port();
      host = host_of(place).empty() ? "127.0.0.1" : host_of(place);
    }
    acceptor.listen();
  }

  std::string
  Server::invitation() const
  {
    if (socket_file.empty())
      return fmt::format("Open http://{}:{}/?token={}", host, port, access.get_token());
    return fmt::format("On the machine where you look: ssh -N -L 8080:{} HOST\n"
                       "Open http://127.0.0.1:8080/?token={}",
                       std::filesystem::absolute(socket_file).string(), access.get_token());
  }

  void
  Server::accept_next()
  {
    acceptor.async_accept(
        [this](const beast::error_code error, Protocol::socket socket)
        {
          if (error == asio::error::operation_aborted)
            return;
          if (!error && *n_connections < max_connections)
            std::make_shared<Connection>(Stream(std::move(socket)), access, site, audience,
                                         counted(n_connections))
                ->read_next();
          else if (!error)
            audience.get_log().refuse("one connection more than may be");
          if (!error)
            return accept_next();
          // for instance without free descriptors
          auto timer
              = std::make_shared<asio::steady_timer>(context, std::chrono::milliseconds(100));
          timer->async_wait([this, timer](const beast::error_code) { accept_next(); });
        });
  }

  void
  Server::run()
  {
    context.run();
    signals.cancel();
    signals.clear();    // a second signal ends the program during a long step
    audience.dismiss(); // viewers' sockets must not outlive the context
  }
} // namespace Exemplar::Live
