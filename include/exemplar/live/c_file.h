// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_c_file_h
#define exemplar_live_c_file_h

#include <cstdio>
#include <memory>

namespace Exemplar::Live
{
  /// Deleter that closes a file of std::fopen or std::tmpfile.
  struct CloseFile
  {
    void
    operator()(std::FILE *file) const
    {
      std::fclose(file);
    }
  };

  /// An owned file of C's library, as only these can be without a name.
  using CFile = std::unique_ptr<std::FILE, CloseFile>;
} // namespace Exemplar::Live

#endif
