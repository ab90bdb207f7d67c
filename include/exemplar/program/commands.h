// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_commands_h
#define exemplar_commands_h

#include <exemplar/surface/filling/surface_meshing.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// The program's commands and their options.

namespace Exemplar
{
  /// Options of a run.
  struct RunOptions
  {
    std::filesystem::path    scene_file;
    std::vector<std::string> overrides; ///< "Section/Key=value"
    bool                     resume = false;
    bool                     quiet  = false;

    std::optional<unsigned int> resume_from; ///< the step after which to continue, with this scene
    bool                        verbose   = false; ///< a line an iteration instead of the bar
    unsigned int                n_threads = 1;
    bool allow_commands = false; ///< whether a .geo may run programs and write files
  };

  /// Solve a scene from its first (or, if resumed, its next) step to the last and write the
  /// results. Throws UserError before anything is written; SolverFailure and Interrupted after all
  /// results so far are on disk.
  void
  run_scene(const RunOptions &options);

  /// Read and check a scene and its files; compute and write nothing. Throws UserError.
  void
  validate_scene(const RunOptions &options);

  /// Print every parameter with its default, range, unit and meaning, as a .prm.
  void
  print_parameters();

  /// Options of `exemplar mesh`.
  struct MeshCommandOptions
  {
    SurfaceMeshingOptions meshing;
    std::filesystem::path output; ///< .msh; the table .csv is written next to it
    bool                  quiet = false;
    std::filesystem::path faults; ///< .csv; if given, faults are listed and no mesh is made
  };

  /// Make a mesh inside a surface, write it and its table, and print the table; or, if `faults` is
  /// given, write a table of the surface's faults. Nothing is written if anything fails. Throws
  /// UserError, and SolverFailure as mesh_surface().
  void
  run_mesh_command(const MeshCommandOptions &options);

  /// Options of `exemplar pose`.
  struct PoseOptions
  {
    std::filesystem::path    mesh, rest, output;
    std::vector<std::string> poses; ///< files, or patterns of files with * and ?
    double                   attach    = 30.;
    unsigned int             n_threads = 1;
    bool                     quiet     = false;
  };

  /// Carry each pose of the surface onto the mesh: write OUTPUT/NAME.msh for a pose NAME.obj, and
  /// OUTPUT/poses.csv. Throws UserError before anything is written, and SolverFailure, with the
  /// elements, after the other poses are written, if cells stay inverted.
  void
  carry_poses(const PoseOptions &options);

  /// Options of `exemplar convert`.
  struct ConvertOptions
  {
    std::filesystem::path input, output;
  };

  /// Read a mesh and write it in the format of the output's extension; print what was read as what,
  /// and what the format cannot hold. Throws UserError with nothing written.
  void
  convert_mesh(const ConvertOptions &options);

  /// Options of `exemplar export`. Either `html` or `gltf` is given.
  struct ExportOptions
  {
    std::vector<std::string>    runs; ///< output directories
    std::string                 html; ///< file of the page
    std::string                 gltf; ///< file of the shapes and their weights, of one run
    std::optional<unsigned int> n_shapes;
    bool                        with_normals = false;
  };

  /// Write what shows runs elsewhere, and print its accuracy. Throws UserError with nothing
  /// written.
  void
  export_runs(const ExportOptions &options);
} // namespace Exemplar

#endif
