// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/base/words.h>
#include <exemplar/run/scene/scene_parameters.h>

namespace Exemplar
{
  namespace
  {
    /// A key of a solid that the scene sets, and how it is done without.
    std::string
    key_of_solids(const SceneParameters &scene)
    {
      std::string key;
      scene.material.for_each_section(
          [&](const ElasticConstants &constants, const std::string &section)
          {
            for (const auto &[name, value] : constants.own)
              if (value != default_own_constants().at(name))
                key = section + "/" + name;
            if (!constants.orthotropy.empty())
              key = section + "/Orthotropy";
            if (constants.has_tension())
              key = section + "/Fibre tension";
          });
      if (!key.empty())
        return key;
      const ModelParameters usual;
      if (scene.model.element != usual.element)
        key = "Model/Element = P2";
      if (scene.model.strain != usual.strain)
        key = "Model/Strain";
      if (scene.model.background != usual.background)
        key = "Model/Background";
      if (scene.model.gradient != usual.gradient)
        key = "Model/Gradient = frozen";
      if (scene.model.dilatation == DilatationKind::patches)
        key = "Model/Dilatation = patches";
      return key;
    }
  } // namespace

  void
  CompleteScene::check_shell() const
  {
    const bool is_shell = mesh.kind == MeshKind::shell;
    for (const HandleParameters &handle : handles)
      refuse(
          { { is_shell && handle.slopes == "held" && !handle.follow_cache.empty(),
              "Handles/" + handle.name
                  + "/Slopes = held: a cache (Follow cache) says where vertices are, and nothing "
                    "of the normals between them. Set Slopes = free, and hold two rows of "
                    "vertices for a clamp." },
            { is_shell && handle.slopes == "held" && model.shell == ShellKind::hinges,
              "Handles/" + handle.name
                  + "/Slopes = held: with Model/Shell = hinges a shell has no slopes, so that a "
                    "plane of symmetry or a clamp would be a hinge. Set Model/Shell = plate, or "
                    "set "
                    "Slopes = auto and hold two rows of vertices for a clamp." },
            { !is_shell && handle.slopes != HandleParameters().slopes,
              "Handles/" + handle.name
                  + "/Slopes is of shells. Set Mesh/Kind = shell, or remove it." } });
    const bool has_regions = !material.regions.empty() || !material.named_regions.empty();
    material.for_each_section(
        [&](const ElasticConstants &constants, const std::string &section)
        {
          // triangles of no region are refused where they are known, if regions alone say how thick they are
          const bool may_be_left_out
              = has_regions && section == "Material" && constants.thickness == 0.;
          refuse({ { !is_shell && constants.thickness > 0.,
                     section + "/Thickness is of shells. Set Mesh/Kind = shell, or remove it." },
                   { is_shell && !(constants.thickness >= least_thickness) && !may_be_left_out,
                     too_thin_text(section + "/Thickness", constants.thickness) } });
        });
    refuse({ { !is_shell && !material.thickness_map.empty(),
               "Material/Thickness map is of shells. Set Mesh/Kind = shell, or remove it." },
             { !is_shell && material.volume_stiffness > 0.,
               "Material/Volume stiffness is of shells. Set Mesh/Kind = shell, or remove it." } });
    if (!is_shell)
      return;
    const std::string solid = key_of_solids(*this), key = "Mesh/Kind = shell: ";
    refuse({
        { !solid.empty(),
          key + solid + " is of bodies with a volume. Remove it"
              + (ends_with(solid, "/Yield stress") ? ": a sheet does not flow, but Examples/Yield "
                                                     "lets it keep the weights of its "
                                                     "examples. Or"
                                                   : ", or")
              + " set Mesh/Kind = solid." },
        { mesh.n_cells != MeshParameters().n_cells || mesh.repair,
          key
              + "Mesh/Cells and Repair fill a surface with cells. Remove them, or set Mesh/Kind "
                "= solid." },
        { mesh.generator != MeshGenerator::none,
          key
              + "Mesh/Generator makes tetrahedra. Give a surface or a .msh of triangles as "
                "Mesh/File." },
        { material.volume_stiffness > 0.
              && (solver.linear_solver == LinearSolver::iterative
                  || solver.linear_solver == LinearSolver::umfpack),
          key
              + "Material/Volume stiffness couples all nodes, which Solver/Linear solver = "
                "iterative and umfpack do not take. Set it to auto." },
        { reads_off_surface() && !is_surface_file(mesh.file) && !mesh.file.empty(),
          key + key_read_off_surface() + " is read off a surface, of which Mesh/File = " + mesh.file
              + " is none. Give an .obj, .ply or .stl, or remove it." },
        { !mesh.surface.empty(), key
                                     + "Mesh/Surface is the surface that cells fill, but a shell "
                                       "is its own. Remove it." },
        { output.shows_surface() && !is_surface_file(mesh.file),
          key + "Output/Formats has a format that shows a surface, of which Mesh/File = "
              + mesh.file + " is none. Give an .obj, .ply or .stl, or set Output/Formats = vtu." },
        { !mesh.carried.empty(), key + "Mesh/Carry is not for shells. Remove it." },
        { !mesh.files.empty() || !ties.empty(),
          key
              + "Mesh/Files and Ties are not for shells yet. Give one Mesh/File, in pieces if "
                "need be. Sheets and solids in one scene are not supported." },
        { loads.balanced, key + "Loads/Balanced = true is not for shells yet. Set it to false." },
        { examples.regions != RegionsOfExamples::none,
          key
              + "Examples/Regions = auto is not for shells yet. Set it to none; Weights per region "
                "gives material ids weights of their own." },
        { examples.acts_on != ActsOn::all || examples.elasticity().is_own(),
          key
              + "Examples/Acts on, Example modulus and Example Poisson ratio are of bodies with "
                "a volume. Remove them." },
        { examples.importance * examples.bending_importance > 1.,
          "Examples/Bending importance times Importance = "
              + shortest_text(examples.importance * examples.bending_importance)
              + " is above 1, so that a shell would go beyond its examples. Lower one of them." },
        { solver.starts == Starts::examples,
          key + "Solver/Starts = examples is not for shells yet. Set it to state." },
        { solver.method == Method::one_pass || solver.method == Method::fixed_point,
          key
              + "Solver/Method = one pass and fixed point hold rotations of cells. Set it to "
                "auto." },
        { output.space_error != SpaceErrorUse::never,
          key + "Output/Space error compares tetrahedra. Set it to false." },
        { !obstacles.empty() && obstacles.free == FreeBodies::weak_springs,
          key
              + "Obstacles/Free = weak springs is not for shells, which bend more easily than "
                "these springs. Set it to friction, or hold more nodes." },
        { !contact.empty(),
          key
              + "Contact/Bodies and Self, of pieces with each other and themselves, are not for "
                "shells yet. Set them to false." },
    });
  }
} // namespace Exemplar
