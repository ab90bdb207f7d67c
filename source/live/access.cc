// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/live/access.h>

#include <openssl/crypto.h>
#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <stdexcept>

namespace Exemplar::Live
{
  namespace
  {
    /// Hexadecimal digits of n random bytes.
    template <std::size_t n>
    std::string
    random_word()
    {
      std::array<unsigned char, n> bytes{};
      if (RAND_bytes(bytes.data(), n) != 1)
        throw std::runtime_error("The system gives no random numbers.");
      std::string word;
      for (const unsigned char byte : bytes)
        for (const int digit : { byte / 16, byte % 16 })
          word += "0123456789abcdef"[digit];
      return word;
    }

    /// Constant-time comparison, which does not reveal where texts differ.
    bool
    are_same(const std::string_view a, const std::string_view b)
    {
      return a.size() == b.size() && CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
    }

    std::string
    lower(const std::string_view text)
    {
      std::string result(text);
      for (char &letter : result)
        if (letter >= 'A' && letter <= 'Z')
          letter = static_cast<char>(letter - 'A' + 'a');
      return result;
    }

    std::string_view
    without_blanks(std::string_view text)
    {
      while (!text.empty() && text.front() == ' ')
        text.remove_prefix(1);
      while (!text.empty() && text.back() == ' ')
        text.remove_suffix(1);
      return text;
    }

    /// The name in NAME:PORT; PORT is digits.
    std::string_view
    without_port(const std::string_view host)
    {
      const auto colon = host.rfind(':');
      if (colon == std::string_view::npos || host.find(']', colon) != std::string_view::npos)
        return host;
      const std::string_view port    = host.substr(colon + 1);
      const bool             is_port = !port.empty() && port.size() <= 5
                           && port.find_first_not_of("0123456789") == std::string_view::npos;
      return is_port ? host.substr(0, colon) : std::string_view();
    }
    /// Throws UserError for a name that cannot be in a Host header.
    void
    require_host(const std::string &host)
    {
      const bool        is_ip6 = host.size() > 2 && host.front() == '[' && host.back() == ']';
      const std::string allowed
          = is_ip6 ? "[]0123456789abcdefABCDEF:."
                   : "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_";
      if (host.empty() || host.find_first_not_of(allowed) != std::string::npos)
        throw UserError("--allow-host " + in_quotes(host)
                        + ": this is no name of a machine. Give one without http:// and without a "
                          "port, like box.example or [fe80::1]; any port is let in.");
    }
  } // namespace

  Access::Access(const std::vector<std::string> &more_hosts, const std::string &listening)
      : hosts{ "127.0.0.1", "localhost", "[::1]" }, token(random_word<16>()),
        cookie_name("exemplar_" + random_word<4>()), cookie_value(random_word<16>())
  {
    for (const std::string &host : more_hosts)
    {
      require_host(host);
      hosts.push_back(lower(host));
    }
    if (!listening.empty())
      hosts.push_back(lower(listening));
  }

  std::string
  Access::cookie_to_set() const
  {
    return cookie_name + "=" + cookie_value + "; Path=/; HttpOnly; SameSite=Lax";
  }

  bool
  Access::knows_host(const std::string_view host) const
  {
    return std::find(hosts.begin(), hosts.end(), lower(without_port(host))) != hosts.end();
  }

  bool
  Access::is_own_origin(const std::string_view origin, const std::string_view host)
  {
    return !host.empty()
           && (lower(origin) == "http://" + lower(host)
               || lower(origin) == "https://" + lower(host));
  }

  bool
  Access::is_token(const std::string_view text) const
  {
    return are_same(text, token);
  }

  bool
  Access::has_cookie(std::string_view header) const
  {
    const std::string wanted = cookie_name + "=" + cookie_value;
    while (!header.empty())
    {
      const auto end = std::min(header.find(';'), header.size());
      if (are_same(without_blanks(header.substr(0, end)), wanted))
        return true;
      header.remove_prefix(std::min(end + 1, header.size()));
    }
    return false;
  }

  std::string_view
  value_in_query(std::string_view target, const std::string_view key)
  {
    target.remove_prefix(std::min(target.find('?'), target.size()));
    while (!target.empty())
    {
      target.remove_prefix(1); // ? or &
      const auto             end  = std::min(target.find('&'), target.size());
      const std::string_view pair = target.substr(0, end);
      if (pair.size() > key.size() && pair.substr(0, key.size()) == key && pair[key.size()] == '=')
        return pair.substr(key.size() + 1);
      target.remove_prefix(end);
    }
    return {};
  }
} // namespace Exemplar::Live
