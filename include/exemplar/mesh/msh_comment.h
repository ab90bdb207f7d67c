// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_msh_comment_h
#define exemplar_msh_comment_h

#include <string>

// A .msh may have a section of comments, which its readers pass over.

namespace Exemplar
{
  /// The bytes of a .msh with a one-line comment appended.
  std::string
  with_comment(std::string msh, const std::string &line);

  /// The comment, or the bytes without it. Both throw std::runtime_error if there is none.
  std::string
  comment_of(const std::string &msh);
  std::string
  without_comment(const std::string &msh);
} // namespace Exemplar

#endif
