// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_parameters_h
#define exemplar_parameters_h

#include <exemplar/body/example_parameters.h>
#include <exemplar/body/handle_parameters.h>
#include <exemplar/body/load_parameters.h>
#include <exemplar/body/material_parameters.h>
#include <exemplar/body/model_parameters.h>
#include <exemplar/body/time_parameters.h>
#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/prm/prm_tools.h>
#include <exemplar/run/initial_parameters.h>
#include <exemplar/run/output_parameters.h>
#include <exemplar/solvers/solver_parameters.h>

#include <deal.II/base/parameter_handler.h>

#include <filesystem>
#include <string>
#include <vector>

namespace Exemplar
{
  enum class SceneKind
  {
    interpolation,
    statics,
    dynamic
  };

  /// Everything a scene file says. Each part declares its own section; what
  /// concerns several sections is checked here.
  class Parameters
  {
  public:
    /// The defaults, with one sample of each named subsection; for the reference.
    Parameters();

    /// Read a scene and the command line's overrides ("Section/Key=value"). Throws
    /// UserError.
    Parameters(const std::filesystem::path &scene_file, const std::vector<std::string> &overrides);

    /// The same from the text of a scene, as if `scene_file` contained it.
    Parameters(const std::filesystem::path    &scene_file,
               const std::string              &scene_text,
               const std::vector<std::string> &overrides);

    /// The same, with overrides that know their places.
    Parameters(const std::filesystem::path   &scene_file,
               const std::string             &scene_text,
               const std::vector<Assignment> &overrides);

    Parameters(const Parameters &) = delete;
    Parameters &
    operator=(const Parameters &)
        = delete;

    /// All keys with the values in force; input files are absolute.
    std::vector<DeclaredKey>
    keys() const;

    /// The input files that the scene needs.
    std::vector<std::filesystem::path>
    input_files() const;

    std::filesystem::path         scene_file;
    std::string                   scene_text; ///< of the file, byte for byte
    SceneKind                     scene = SceneKind::dynamic;
    MeshParameters                mesh;
    MaterialParameters            material;
    ModelParameters               model;
    ExampleParameters             examples;
    std::vector<HandleParameters> handles;
    dealii::Tensor<1, 3>          gravity;
    std::vector<LoadParameters>   loads;
    InitialParameters             initial;
    TimeParameters                time;
    SolverParameters              solver;
    OutputParameters              output;

  private:
    void
    declare_sections();

    void
    declare_named_subsections(const std::vector<Assignment> &assignments);

    void
    set(const std::vector<std::string> &subsections,
        const std::string              &key,
        const std::string              &value);

    void
    make_selections_absolute();

    void
    complete_interpolation(const std::vector<Assignment> &assignments);

    void
    choose_method();

    void
    check() const;

    dealii::ParameterHandler prm;
    std::vector<std::string> handle_names;
    std::vector<std::string> load_names;
  };
} // namespace Exemplar

#endif
