// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_c_file_h
#define exemplar_live_c_file_h

#include <cstdio>
#include <memory>

namespace Exemplar::Live
{
  /// Ends what std::fopen or std::tmpfile began.
  struct CloseFile
  {
    void
    operator()(std::FILE *file) const
    {
      std::fclose(file);
    }
  };

  /// A file that is closed with this; files of C, as only they may have no name.
  using CFile = std::unique_ptr<std::FILE, CloseFile>;
} // namespace Exemplar::Live

#endif
