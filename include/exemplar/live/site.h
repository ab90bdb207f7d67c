// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_site_h
#define exemplar_live_site_h

#include <exemplar/live/access.h>

#include <boost/beast/http.hpp>

#include <map>
#include <optional>
#include <string>

namespace Exemplar::Live
{
  using Request  = boost::beast::http::request<boost::beast::http::string_body>;
  using Response = boost::beast::http::response<boost::beast::http::string_body>;

  /// The files of the page, read once: requests look up a path in a table, and never reach the
  /// disk.
  class Site
  {
  public:
    /// The page at which a body is pulled. Throws UserError if a file of it or of three.js is
    /// missing.
    Site();

    /// A site of one page that needs no other file, and no WebSocket.
    explicit Site(std::string page);

    /// What is drawn instead of the body's boundary, SkinFrames::topology(); no file of it while that is empty. To be called
    /// before requests come.
    void
    set_surface(const std::string &bytes);

    /// A file's media type and bytes, and the sources that its content policy allows.
    struct File
    {
      std::string type, bytes, sources;
    };

    /// The file of a path; null if there is none.
    const File *
    find(const std::string &path) const;

    /// Whether viewers may connect by WebSocket.
    bool
    has_socket() const
    {
      return is_live;
    }

  private:
    std::map<std::string, File> files;
    bool                        is_live;
  };

  /// The reason to refuse a request by its headers, in words for the log; empty: it is admitted.
  std::string
  objection_to(const Request &request, const Access &access);

  /// The response to a request that is no WebSocket's. `objection` is that of objection_to().
  Response
  answer(const Request     &request,
         const Access      &access,
         const Site        &site,
         const std::string &objection);
} // namespace Exemplar::Live

#endif
