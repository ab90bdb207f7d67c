// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/base/words.h>
#include <exemplar/mesh/map_name.h>

#include <regex>

namespace Exemplar
{
  std::string
  MapName::name() const
  {
    return attribute.empty() ? file : file + ":" + attribute;
  }

  MapName
  split_map_name(const std::string &text, const std::string &key)
  {
    static const std::regex pattern(R"((.*?\.(?:ply|csv))(?::(\S+))?(?:\s+(.*))?)",
                                    std::regex::icase);
    std::smatch             parts;
    const std::string       trimmed = trim(text);
    if (!std::regex_match(trimmed, parts, pattern))
      throw UserError(key + ": " + in_quotes(text)
                      + " names no painted map. Give FILE.ply:ATTRIBUTE with an attribute of the "
                        "vertices, or FILE.csv or FILE.csv:COLUMN.");
    return { parts[1], parts[2], trim(parts[3]) };
  }
} // namespace Exemplar
