// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/plain_name.h>

#include <algorithm>

namespace Exemplar
{
  void
  require_plain_name(const std::string &name, const std::string &what)
  {
    const bool has_forbidden = std::any_of(name.begin(), name.end(),
                                           [](const char c)
                                           {
                                             const auto code = static_cast<unsigned char>(c);
                                             return code < 32 || code == 127 || c == ',';
                                           });
    if (name.empty() || has_forbidden || name.front() == ' ' || name.back() == ' ')
      throw UserError(what + ": the name " + in_quotes(name)
                      + " is not allowed. A name has at least one character, no comma, no line "
                        "break or other control character, and no blank at its ends.");
  }
} // namespace Exemplar
