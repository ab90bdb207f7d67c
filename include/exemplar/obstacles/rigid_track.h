// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_rigid_track_h
#define exemplar_rigid_track_h

#include <array>
#include <filesystem>
#include <vector>

namespace Exemplar
{
  /// A rigid motion in frames: linear between them, at rest before the first and after the last.
  struct RigidTrack
  {
    /// A displacement [m], in the file its unit, and a rotation vector [rad].
    using Frame = std::array<double, 6>;

    std::vector<double> times; ///< [s], ascending; empty: no track
    std::vector<Frame>  frames;
    bool is_of_space = false; ///< whether the origin is displaced, not the obstacle's middle

    /// The frame at a time [s].
    Frame
    at(double time) const;

    template <typename Archive>
    void
    serialize(Archive &archive, unsigned int /*version*/)
    {
      archive &times &frames &is_of_space;
    }
  };

  /// Reads lines of t and a displacement and a rotation vector, or of t and the rows of a matrix (R p), which takes x to
  /// R x + p; separated by blanks or commas, with comments after #. The angle of the next rotation vector is then as near as
  /// it can be. Throws UserError with the line for what is none of these.
  RigidTrack
  read_rigid_track(const std::filesystem::path &file);
} // namespace Exemplar

#endif
