// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/build_identity.h>
#include <exemplar/base/digest.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/kept_bytes.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/gmsh_session.h>
#include <exemplar/mesh/msh_comment.h>
#include <exemplar/run/inputs/surface_inputs.h>
#include <exemplar/run/scene/scene_parameters.h>
#include <exemplar/surface/files/surface_scanner.h>
#include <exemplar/surface/making/mesh_making.h>
#include <exemplar/surface/making/parted_sheets.h>
#include <exemplar/surface/posing/pose_carrying.h>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>
#include <optional>

namespace Exemplar
{
  namespace
  {
    namespace fs = std::filesystem;
    using Json   = nlohmann::ordered_json;

    /// Identity of this program and of gmsh's library, for keys of the cache.
    std::string
    maker()
    {
      return own_build_identity() + " " + gmsh_identity() + "\n";
    }

    /// Digest of a surface file's bytes, and its format.
    std::string
    surface_digest(const std::string &file)
    {
      return sha256_of_text(read_surface_bytes(file)) + fs::path(file).extension().string() + "\n";
    }

    /// Digest of the mesh data that a pose on it depends on.
    std::string
    mesh_digest(const MshFile &mesh)
    {
      Sha256     digest;
      const auto add = [&](const auto *numbers, const std::size_t n)
      { digest.update(reinterpret_cast<const char *>(numbers), n * sizeof(*numbers)); };
      add(mesh.node_numbers.data(), mesh.node_numbers.size());
      for (const dealii::Point<3> &node : mesh.nodes)
        add(node.begin_raw(), 3);
      for (const MshElement &element : mesh.elements)
        if (element.type == MshElementType::tetrahedron)
          add(element.nodes.data(), element.nodes.size());
      return digest.hex_digest() + "\n";
    }

    std::string
    to_text(const PoseQuality &q)
    {
      return Json{ q.n_inverted, q.min_det,      q.max_det,      q.min_stretch, q.stretch_1,
                   q.stretch_99, q.max_stretch,  q.mean_error,   q.max_error,   q.rotation,
                   q.shift,      q.longest_edge, q.edge_at_rest, q.motion,      q.edge,
                   q.edge_place, q.vertex,       q.vertex_place }
          .dump();
    }

    PoseQuality
    quality_from_text(const std::string &text)
    {
      const Json  n = Json::parse(text);
      PoseQuality q;
      q.n_inverted  = n.at(0);
      std::size_t i = 1;
      for (double *const number :
           { &q.min_det, &q.max_det, &q.min_stretch, &q.stretch_1, &q.stretch_99, &q.max_stretch,
             &q.mean_error, &q.max_error, &q.rotation, &q.shift, &q.longest_edge, &q.edge_at_rest,
             &q.motion })
        *number = n.at(i++);
      q.edge         = n.at(i).get<decltype(q.edge)>();
      q.edge_place   = n.at(i + 1).get<decltype(q.edge_place)>();
      q.vertex       = n.at(i + 2);
      q.vertex_place = n.at(i + 3).get<decltype(q.vertex_place)>();
      return q;
    }
  } // namespace

  /// Surface and transfer with which poses are carried.
  struct SurfaceInputs::Poses
  {
    explicit Poses(const fs::path &file) : rest(file) {}

    /// The transfer to the mesh, the same at each call; made at the first one.
    PoseTransfer &
    transfer_to(const MshFile &contents, const SceneParameters &scene)
    {
      if (!transfer)
      {
        mesh.emplace(contents, scene.mesh.name());
        transfer.emplace(
            make_pose_transfer(*mesh, rest, scene.examples.attach, scene.solver.n_threads));
      }
      return *transfer;
    }

    const RestSurface                  rest;
    std::map<std::string, SurfaceMesh> surfaces;
    std::optional<const Mesh>          mesh;
    std::optional<PoseTransfer>        transfer;
  };

  SurfaceInputs::SurfaceInputs(const SceneParameters &scene, Announce announce)
      : scene(scene), announce(announce ? std::move(announce) : [](const std::string &) {})
  {
  }

  SurfaceInputs::~SurfaceInputs() = default;

  MadeOfSurfaces &
  SurfaceInputs::get_made_anew()
  {
    if (made == nullptr)
      made = std::make_shared<MadeOfSurfaces>();
    return *made;
  }

  void
  SurfaceInputs::read_pose(const std::string &file)
  {
    if (poses == nullptr)
      poses = std::make_unique<Poses>(scene.mesh.surface_file());
    if (poses->surfaces.count(file) == 0)
      poses->surfaces[file] = read_pose_surface(file, poses->rest);
  }

  std::vector<fs::path>
  SurfaceInputs::parting_poses() const
  {
    std::vector<fs::path> files;
    if (poses != nullptr && has_crossing_sheets(poses->rest.surface))
      for (const auto &[file, surface] : poses->surfaces)
        files.emplace_back(file);
    return files;
  }

  MshFile
  SurfaceInputs::make_mesh()
  {
    const MeshParameters &mesh = scene.mesh;
    SurfaceMeshingOptions options{ mesh.file, mesh.n_cells, mesh.repair,         parting_poses(),
                                   "",        "Mesh/Cells", "Mesh/Repair = true" };
    std::string           digests = surface_digest(mesh.file);
    for (const fs::path &pose : options.poses)
      digests += surface_digest(pose.string());
    const std::string key = sha256_of_text(
        fmt::format("{}{}{}{}", maker(), digests, mesh.n_cells, mesh.repair ? " repaired" : ""));
    const KeptBytes kept
        = kept_bytes(key + ".msh",
                     [&]
                     {
                       announce(fmt::format("filling {} with {} cells", mesh.file, mesh.n_cells));
                       return Exemplar::make_mesh(options);
                     });
    get_made_anew().mesh = report_in(kept.bytes);
    add_warning(kept.warning);
    return read_msh_bytes(kept.bytes, mesh.file);
  }

  std::vector<dealii::Point<3>>
  SurfaceInputs::carry(const std::string &file, const MshFile &mesh)
  {
    const std::string key
        = sha256_of_text(maker() + mesh_digest(mesh) + surface_digest(poses->rest.name)
                         + surface_digest(file) + shortest_text(scene.examples.attach));
    const KeptBytes kept = kept_bytes(
        key + ".msh",
        [&]
        {
          PoseTransfer &transfer = poses->transfer_to(mesh, scene);
          announce("carrying " + file + " onto the mesh");
          PoseQuality quality;
          MshFile     pose      = mesh;
          pose.nodes            = transfer.carry(poses->surfaces.at(file).vertices, quality);
          const std::string bad = inverted_elements(transfer, *poses->mesh, pose.nodes);
          if (!bad.empty())
            throw SolverFailure(file + ": cells stay inverted in this pose: element " + bad
                                + ". Attach the surface more softly, by Examples/Attach, or take a "
                                  "finer mesh, by Mesh/Cells.");
          return with_comment(msh_text(pose), to_text(quality));
        });
    get_made_anew().poses.push_back({ file, quality_from_text(comment_of(kept.bytes)) });
    add_warning(kept.warning);
    return read_msh_bytes(kept.bytes, file).nodes;
  }

  void
  SurfaceInputs::add_warning(const std::string &warning)
  {
    std::vector<std::string> &warnings = get_made_anew().warnings;
    if (!warning.empty() && std::find(warnings.begin(), warnings.end(), warning) == warnings.end())
      warnings.push_back(warning);
  }
} // namespace Exemplar
