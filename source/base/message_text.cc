// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/message_text.h>

#include <algorithm>

namespace Exemplar
{
  namespace
  {
    bool
    continues(const std::string_view text, const std::size_t i)
    {
      return i < text.size() && (static_cast<unsigned char>(text[i]) & 0xc0) == 0x80;
    }

    /// Number of bytes of the character at a position (RFC 3629); 0 if it is invalid or a control
    /// character.
    std::size_t
    character_size(const std::string_view text, const std::size_t at)
    {
      const auto        c    = static_cast<unsigned char>(text[at]);
      const auto        next = static_cast<unsigned char>(at + 1 < text.size() ? text[at + 1] : 0);
      const std::size_t size = c < 0x80   ? 1
                               : c < 0xc2 ? 0
                               : c < 0xe0 ? 2
                               : c < 0xf0 ? 3
                               : c < 0xf5 ? 4
                                          : 0;
      for (std::size_t i = 1; i < size; ++i)
        if (!continues(text, at + i))
          return 0;
      const bool controls  = c < 0x20 || c == 0x7f || (c == 0xc2 && next < 0xa0);
      const bool too_long  = (c == 0xe0 && next < 0xa0) || (c == 0xf0 && next < 0x90);
      const bool no_letter = (c == 0xed && next >= 0xa0) || (c == 0xf4 && next >= 0x90);
      return controls || too_long || no_letter ? 0 : size;
    }

    /// End of the character that contains position `at` after its first byte; otherwise `at`.
    std::size_t
    next_begin(const std::string_view text, std::size_t at)
    {
      while (continues(text, at))
        ++at;
      return at;
    }

    /// The text without its middle, if it is longer than n_first + n_last.
    std::string
    shortened(const std::string_view text, const std::size_t n_first, const std::size_t n_last)
    {
      const std::string gap = " [...] ";
      if (text.size() <= n_first + gap.size() + n_last)
        return std::string(text);
      return std::string(text.substr(0, next_begin(text, n_first))) + gap
             + std::string(text.substr(next_begin(text, text.size() - n_last)));
    }
  } // namespace

  std::size_t
  find_unprintable(const std::string_view text)
  {
    for (std::size_t i = 0; i < text.size();)
    {
      const std::size_t size = text[i] == '\t' ? 1 : character_size(text, i);
      if (size == 0)
        return i;
      i += size;
    }
    return std::string_view::npos;
  }

  std::string
  printable(const std::string_view bytes)
  {
    std::string text;
    for (std::size_t i = 0; i < bytes.size();)
    {
      const std::size_t size = character_size(bytes, i);
      if (size > 0)
        text += bytes.substr(i, size);
      else
      {
        const auto byte = static_cast<unsigned char>(bytes[i]);
        text += { '\\', 'x', "0123456789abcdef"[byte / 16], "0123456789abcdef"[byte % 16] };
      }
      i += std::max<std::size_t>(size, 1);
    }
    return text;
  }

  std::string
  in_quotes(const std::string_view word)
  {
    return "'" + shortened(printable(word), 40, 10) + "'";
  }

  std::string
  joined(const std::vector<std::string> &words, const std::string_view separator)
  {
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i)
      text.append(i == 0 ? "" : separator).append(words[i]);
    return text;
  }

  std::string
  message_text(const std::string_view message)
  {
    std::string text;
    for (std::size_t begin = 0; begin <= message.size();)
    {
      const std::size_t end = std::min(message.find("\n  ", begin), message.size());
      text += (begin == 0 ? "" : "\n") + printable(message.substr(begin, end - begin));
      begin = end + 1;
    }
    return shortened(text, 1500, 1000);
  }
} // namespace Exemplar
