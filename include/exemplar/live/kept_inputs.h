// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_kept_inputs_h
#define exemplar_live_kept_inputs_h

#include <exemplar/exemplar.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// The input files of a scene, copied for a recording: files of the scene may be saved anew while
  /// a session lasts, and the recording must play with those that the session has read.
  class KeptInputs
  {
  public:
    /// Notes names and contents of the files, before they are read. Throws UserError for one that
    /// is no regular file, as it cannot be read again; a missing file is left to its reader.
    explicit KeptInputs(const SceneFile &scene);

    /// Copies them to inputs/ in a directory, each into a folder that is named by the content, so
    /// that later copies replace nothing; for a .geo, which may take in others, `mesh` is written
    /// that it gave. Returns the keys of the scene with the names of the copies, relative to the
    /// directory. To be called after all has been read. Throws UserError, with nothing left behind,
    /// if a file has changed meanwhile, or if a copy fails.
    std::vector<DeclaredKey>
    copy_to(const std::filesystem::path &directory, const MshFile &mesh) const;

  private:
    /// A key of the scene that names a file or a sequence of files.
    struct Named
    {
      std::string                        key; ///< its path
      std::string                        name;
      std::vector<std::filesystem::path> files;
      std::string                        digest; ///< digest of all files
    };

    std::vector<DeclaredKey> keys;
    std::vector<Named>       all; ///< keys whose files exist
  };
} // namespace Exemplar::Live

#endif
