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

  /// The files of the page, read once: a request names one of a table, and no path of it reaches the disk.
  class Site
  {
  public:
    /// The page at which a body is pulled. Throws UserError if a file of it or of three.js is missing.
    Site();

    /// One page that needs no other, and no WebSocket.
    explicit Site(std::string page);

    /// A file's type and bytes, and what of it a browser may carry out.
    struct File
    {
      std::string type, bytes, sources;
    };

    /// Null for paths that are none of the table.
    const File *
    find(const std::string &path) const;

    /// Whether viewers may come.
    bool
    has_socket() const
    {
      return is_live;
    }

  private:
    std::map<std::string, File> files;
    bool                        is_live;
  };

  /// Why a request is refused before it is looked at, in words for the log; empty: it is not.
  std::string
  objection_to(const Request &request, const Access &access);

  /// What a request that is no WebSocket's gets. `objection` as above.
  Response
  answer(const Request     &request,
         const Access      &access,
         const Site        &site,
         const std::string &objection);
} // namespace Exemplar::Live

#endif
