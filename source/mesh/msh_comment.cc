// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/mesh/msh_comment.h>

#include <stdexcept>

namespace Exemplar
{
  namespace
  {
    const std::string comment_begin = "\n$Comments\n", comment_end = "\n$EndComments\n";

    /// Position of the last comment.
    std::size_t
    comment_place(const std::string &msh)
    {
      const std::size_t at = msh.rfind(comment_begin);
      if (at == std::string::npos)
        throw std::runtime_error("A .msh has no comment.");
      return at;
    }
  } // namespace

  std::string
  with_comment(std::string msh, const std::string &line)
  {
    if (!msh.empty() && msh.back() == '\n')
      msh.pop_back();
    return msh + comment_begin + line + comment_end;
  }

  std::string
  comment_of(const std::string &msh)
  {
    const std::size_t line = comment_place(msh) + comment_begin.size();
    return msh.substr(line, msh.find(comment_end, line) - line);
  }

  std::string
  without_comment(const std::string &msh)
  {
    return msh.substr(0, comment_place(msh) + 1);
  }
} // namespace Exemplar
