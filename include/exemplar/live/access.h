// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_access_h
#define exemplar_live_access_h

#include <string>
#include <string_view>
#include <vector>

namespace Exemplar::Live
{
  /// Access control of the server. A stranger is a page of another site in the user's browser, or
  /// another user of the machine: neither knows the token, which is in the address that the program
  /// prints, or the cookie for which it is exchanged.
  class Access
  {
  public:
    /// `more_hosts` are host names of a proxy, allowed beside those of this machine and of the
    /// address `listening`, which may be empty. Throws UserError for an invalid name. Token and
    /// cookie are random bytes of the system; throws std::runtime_error if it has none to give.
    explicit Access(const std::vector<std::string> &more_hosts, const std::string &listening = "");

    const std::string &
    get_token() const
    {
      return token;
    }

    /// The value of a Set-Cookie header. The cookie's name has a random part, as cookies know no
    /// ports: two servers of one machine would take each other's.
    std::string
    cookie_to_set() const;

    /// Whether the value of a Host header is an allowed name, with any port, as tunnels change it.
    /// Other names are those of sites that were made to resolve to this machine (DNS rebinding).
    bool
    knows_host(std::string_view host) const;

    /// Whether the page with this Origin header was loaded from this host.
    static bool
    is_own_origin(std::string_view origin, std::string_view host);

    bool
    is_token(std::string_view text) const;

    /// Whether the cookie is among those of a Cookie header.
    bool
    has_cookie(std::string_view header) const;

  private:
    std::vector<std::string> hosts;
    const std::string        token, cookie_name, cookie_value;
  };

  /// The value of a key in the query of an address, after the ?; empty if it is not there.
  std::string_view
  value_in_query(std::string_view target, std::string_view key);
} // namespace Exemplar::Live

#endif
