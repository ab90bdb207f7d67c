// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_live_kept_inputs_h
#define exemplar_live_kept_inputs_h

#include <exemplar/exemplar.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar::Live
{
  /// The input files of a scene, copied for a recording: files of the scene may be saved anew while a session lasts,
  /// and the recording must play with those that the session has read.
  class KeptInputs
  {
  public:
    /// Looks at the files before they are read. Throws UserError for one that is no regular file, as it cannot be read
    /// again; one that is missing is left to who reads it.
    explicit KeptInputs(const SceneFile &scene);

    /// Copies them to inputs/ in a directory, each into a folder that is named by the content, so that later copies
    /// replace nothing; for a .geo, which may take in others, `mesh` is written that it gave. Returns the keys of
    /// the scene with the names of the copies, relative to the directory. To be called after all has been read.
    /// Throws UserError, with nothing left behind, if a file has changed meanwhile, or if a copy fails.
    std::vector<DeclaredKey>
    copy_to(const std::filesystem::path &directory, const MshFile &mesh) const;

  private:
    /// What a key calls one file or a sequence of them.
    struct Named
    {
      std::string                        key; ///< its path
      std::string                        name;
      std::vector<std::filesystem::path> files;
      std::string                        digest; ///< of all of them
    };

    std::vector<DeclaredKey> keys;
    std::vector<Named>       all; ///< that are there
  };
} // namespace Exemplar::Live

#endif
