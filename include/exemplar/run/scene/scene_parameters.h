// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_scene_parameters_h
#define exemplar_scene_parameters_h

#include <exemplar/body/example_parameters.h>
#include <exemplar/body/handle_parameters.h>
#include <exemplar/body/load_parameters.h>
#include <exemplar/body/material_parameters.h>
#include <exemplar/body/model_parameters.h>
#include <exemplar/body/time_parameters.h>
#include <exemplar/mesh/mesh_parameters.h>
#include <exemplar/run/scene/initial_parameters.h>
#include <exemplar/run/scene/output_parameters.h>
#include <exemplar/solvers/solver_parameters.h>

#include <array>
#include <string>
#include <vector>

namespace Exemplar
{
  /// What is to be solved.
  enum class SceneKind
  {
    interpolation,
    statics,
    dynamic
  };

  /// What a scene is, in numbers and formulas. A SceneFile fills it from text; a program may
  /// as well fill it by hand.
  struct SceneParameters
  {
    std::string                   name  = "scene"; ///< stands for the scene in messages
    SceneKind                     scene = SceneKind::dynamic;
    MeshParameters                mesh;
    MaterialParameters            material;
    ModelParameters               model;
    ExampleParameters             examples;
    std::vector<HandleParameters> handles;
    LoadsParameters               loads;
    InitialParameters             initial;
    TimeParameters                time;
    SolverParameters              solver;
    OutputParameters              output;
    std::string                   session;  ///< file of what a hand did; empty: nothing
    std::vector<std::string>      warnings; ///< of what the text of the scene says in vain

    /// Whether a part of the scene needs the surface of the body.
    bool
    needs_surface() const;

    /// Whether something is to be read off the surface: nodes, constants, shares or motions.
    bool
    reads_off_surface() const;

  private:
    /// The key that does, for messages; empty: none.
    std::string
    key_read_off_surface() const;

    void
    check_interpolation() const;

    /// Throws UserError where a law of the cells refuses what stands beside it, see Refusal.
    void
    check_laws() const;

    void
    check_starts() const;

    void
    check_solver() const;

    void
    check_surface() const;

    friend class CompleteScene;
  };

  /// A scene with what its kind decides: importance 1 and prescribed weights of an interpolation, and
  /// the method and the dilatation that `automatic` stands for. All that is made of a scene takes one.
  class CompleteScene : public SceneParameters
  {
  public:
    /// Throws UserError for values that contradict each other, which concern several sections, or that
    /// no pattern can tell.
    CompleteScene(SceneParameters scene);

  private:
    void
    complete();

    /// In place of the strain. Throws UserError for a model that has no fibres.
    CellLaw
    law_of_grain(CellLaw law) const;

    void
    check() const;
  };
} // namespace Exemplar

#endif
