// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_frame_formats_h
#define exemplar_frame_formats_h

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace Exemplar
{
  class FESpace;
  struct Frame;
  class FrameWriter;
  class Mesh;
  struct SurfaceMesh;

  /// Playback of an animation.
  struct Playback
  {
    double interval          = 1.; ///< between frames [s]; of t unless dynamic
    double frames_per_second = 24.;
    bool   z_is_up           = false; ///< else y is
    bool   has_velocities    = false;
    bool   with_cells        = true; ///< whether files of scenes have the cells
    bool   with_normals      = true; ///< and normals
  };

  /// The objects that frames show; they outlive the writers.
  struct FrameSubject
  {
    const Mesh           &mesh;
    const FESpace        &fe_space;
    const SurfaceMesh    *surface; ///< in the file's unit; null unless a format shows it
    Playback              playback = {};
    std::string           carried  = {}; ///< name of the surface, if it is one of Mesh/Carry
    std::filesystem::path folder   = {}; ///< of the surface's file
  };

  /// The name, as of a carried surface, of the obstacles' in their files.
  inline const std::string name_of_obstacles = "obstacles";

  /// A file format of frames.
  struct FrameFormat
  {
    using MakeWriter = std::function<std::unique_ptr<const FrameWriter>(const FrameSubject &)>;

    /// Writes the file that joins the pieces of a frame; `pieces` are their file names.
    using JoinPieces = std::function<void(const Frame                    &frame,
                                          const std::vector<std::string> &pieces,
                                          const std::filesystem::path    &file)>;

    std::string name;      ///< in Output/Formats, and extension of frame files
    std::string animation; ///< file name of the animation; empty: none
    MakeWriter  make_writer;

    /// Beginnings of every frame file and every animation; empty: not known.
    std::string frame_beginning = {}, animation_beginning = {};

    bool shows_surface = false; ///< whether the writer needs the surface of the body

    bool shows_velocities = false; ///< whether the writer needs the surface's velocities

    /// If processes share a body, each writes a piece of the frame, and a file joins them: its
    /// writer, extension and beginning; null and empty for formats without pieces.
    JoinPieces  join         = {};
    std::string joint_ending = {}, joint_beginning = {};

    /// Makes writers of surfaces of Mesh/Carry; null: make_writer.
    MakeWriter make_carried_writer = {};

    bool
    has_pieces() const
    {
      return join != nullptr;
    }

    /// The writer for the body's frames, or for those of a surface that it carries.
    std::unique_ptr<const FrameWriter>
    writer_of(const FrameSubject &subject) const;

    /// The file name of a step's frame, without directory, of the body or of the named surface of
    /// Mesh/Carry.
    std::string
    frame_name(unsigned int step, const std::string &carried = "") const;

    /// The file name of the animation, of the body or of a carried surface.
    std::string
    animation_name(const std::string &carried = "") const;

    /// The file names of a step: the frame's for one process, else a piece's for each. Carried
    /// surfaces have no pieces.
    std::vector<std::string>
    names_of_pieces(unsigned int       step,
                    unsigned int       n_processes,
                    const std::string &carried = "") const;

    /// The name of the file that joins the pieces of a step's frame.
    std::string
    joint_name(unsigned int step) const;

    /// The step of a frame or piece of this file name; nothing for other names.
    std::optional<unsigned int>
    step_of(const std::string &file) const;

    /// Whether this is the file name of an animation, of the body or of a carried surface.
    bool
    is_animation(const std::string &file) const;

    /// The beginning of a run's file of this name (without directory); nothing if runs write no
    /// such files.
    std::optional<std::string>
    beginning_of(const std::string &file) const;
  };

  /// All formats.
  const std::vector<FrameFormat> &
  frame_formats();

  /// Names of formats, as in Output/Formats.
  std::vector<std::string>
  names_of(const std::vector<FrameFormat> &formats);
} // namespace Exemplar

#endif
