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
#include <exemplar/obstacles/contact_parameters.h>
#include <exemplar/obstacles/obstacle_parameters.h>
#include <exemplar/obstacles/tie_parameters.h>
#include <exemplar/run/scene/initial_parameters.h>
#include <exemplar/run/scene/output_parameters.h>
#include <exemplar/solvers/solver_parameters.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace Exemplar
{
  /// The problem to be solved.
  enum class SceneKind
  {
    interpolation,
    statics,
    dynamic
  };

  /// Choices of nodes, each with its key.
  using KeyedSelections = std::vector<std::pair<Selection, std::string>>;

  /// The parameters of a scene, filled by a SceneFile from text or by a program.
  struct SceneParameters
  {
    std::string                   name  = "scene"; ///< name of the scene in messages
    SceneKind                     scene = SceneKind::dynamic;
    MeshParameters                mesh;
    MaterialParameters            material;
    ModelParameters               model;
    ExampleParameters             examples;
    std::vector<HandleParameters> handles;
    LoadsParameters               loads;
    ObstaclesParameters           obstacles;
    ContactParameters             contact;
    std::vector<TieParameters>    ties;
    InitialParameters             initial;
    TimeParameters                time;
    SolverParameters              solver;
    OutputParameters              output;
    std::string                   session;  ///< file of the recorded session; empty: none
    std::vector<std::string>      warnings; ///< about text of the scene without effect

    /// Select of all handles and loads, and those of ties.
    KeyedSelections
    selects() const;

    /// These, and Contact/Leave out.
    KeyedSelections
    choices() const;

    /// Choices of nodes by handles, loads, contact and fibre directions.
    KeyedSelections
    selections() const;

    /// Whether a part of the scene needs the surface of the body.
    bool
    needs_surface() const;

    /// Whether nodes, constants, shares or motions are read off the surface.
    bool
    reads_off_surface() const;

    /// The key that reads off the surface, for messages; empty: none.
    std::string
    key_read_off_surface() const;
  };

  /// A scene with the values that its kind determines: importance 1 and prescribed weights of an
  /// interpolation, and the method and dilatation for `automatic`. Problems are made of this type
  /// alone.
  class CompleteScene : public SceneParameters
  {
  public:
    /// Throws UserError for values that contradict each other across sections, or that no pattern
    /// can exclude.
    CompleteScene(SceneParameters scene);

    /// Throws UserError for obstacles that are none, and for what has no place beside any.
    void
    check_obstacles() const;

  private:
    /// Throws UserError for what has no place beside barriers, with what these are and how to do without.
    void
    refuse_beside_barriers(const std::string &what, const std::string &remedy) const;

    /// Throws UserError for what has no place beside a body that may not pass through itself.
    void
    check_contact() const;

    void
    complete();

    /// `law`, the law with fibres, if it may replace the strain; else throws UserError.
    CellLaw
    law_of_grain(CellLaw law) const;

    void
    check() const;

    /// Throws UserError where a law of the cells refuses what stands beside it, see Refusal.
    void
    check_laws() const;

    void
    check_tension() const;

    /// Throws UserError for what shells have no place for, and for what only they have.
    void
    check_shell() const;

    void
    check_ties() const;

    void
    check_starts() const;

    void
    check_solver() const;

    /// Throws UserError for what needs the surface that the scene does not name.
    void
    check_without_surface() const;
  };
} // namespace Exemplar

#endif
