// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/message_text.h>
#include <exemplar/mesh/mesh_edges.h>
#include <exemplar/run/frames/frame_formats.h>
#include <exemplar/run/inputs/parcel.h>
#include <exemplar/run/inputs/shared_body.h>
#include <exemplar/run/scene/scene_parameters.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

namespace Exemplar
{
  namespace
  {
    using Refuse = std::function<void(const std::string &what, const std::string &remedy)>;

    /// Check edge midpoints in poses before linear elements drop them, which the parts could not.
    void
    check_middles(const BodyInputs &whole, const Element element)
    {
      const Mesh &mesh = whole.mesh;
      for (const auto &[name, places] : whole.fields.poses)
        if (element == Element::P1 && places.size() > mesh.n_nodes())
          check_straight(places, edges_of(mesh.get_cells()), mesh.diameter() / mesh.get_scale(),
                         name);
    }

    void
    send_to_all_others(const Parcel &parcel, const MPI_Comm communicator)
    {
      for (unsigned int process = 1;
           process < dealii::Utilities::MPI::n_mpi_processes(communicator); ++process)
        send(parcel, process, communicator);
    }

    /// The root's part: read, send the others their parcels, and keep its own and undivided inputs.
    Parcel
    distribute(const CompleteScene &scene,
               const MPI_Comm       communicator,
               const Announce      &announce,
               UndividedInputs     &undivided)
    {
      Parcel own;
      try
      {
        if (scene.mesh.kind == MeshKind::shell)
          throw UserError(scene.name
                          + ": Mesh/Kind = shell is not for several processes. Start one.");
        BodyInputs whole = read_body(scene, announce);
        check_middles(whole, scene.model.element);
        const std::vector<PartOfBody> parts
            = part_body(whole.mesh, whole.fields.patches, scene.model.element,
                        dealii::Utilities::MPI::n_mpi_processes(communicator));
        for (unsigned int process = 1; process < parts.size(); ++process)
          send(parcel_of(whole, parts[process]), process, communicator);
        own                      = parcel_of(whole, parts[0]);
        own.mesh.arrays.warnings = whole.mesh.get_warnings();
        own.mesh.contents_of_whole
            = std::make_shared<const MshFile>(std::move(whole.mesh).take_contents());
        undivided = std::move(whole.undivided);
        return own;
      }
      catch (const UserError &error)
      {
        own.error = error.what();
      }
      catch (const SolverFailure &failure)
      {
        own.error = failure.what();
      }
      send_to_all_others(own, communicator);
      return own;
    }

    /// Throws UserError for a format that has no pieces for processes.
    void
    check_formats(const OutputParameters &output, const Refuse &refuse)
    {
      std::vector<std::string> allowed;
      for (const FrameFormat &format : frame_formats())
        if (format.has_pieces())
          allowed.push_back(format.name);
      for (const std::string &format : output.formats)
        if (output.every > 0 && std::find(allowed.begin(), allowed.end(), format) == allowed.end())
          refuse("Output/Formats = " + format, "Set it to " + joined(allowed, " or "));
    }
  } // namespace

  void
  check_shareable(const SceneParameters &scene)
  {
    const auto refuse = [&](const std::string &what, const std::string &remedy)
    {
      throw UserError(scene.name + ": " + what + " is for one process. " + remedy
                      + ", or start without mpirun.");
    };
    if (scene.solver.linear_solver != LinearSolver::automatic
        && scene.solver.linear_solver != LinearSolver::iterative)
      refuse("Solver/Linear solver = cholesky, cholmod or umfpack", "Set it to auto or iterative");
    if (scene.examples.in_use() && scene.examples.weights_per_region
        && scene.examples.region_blend_length > 0.)
      refuse("Examples/Region blend length", "Set it to 0");
    if (scene.output.space_error != SpaceErrorUse::never)
      refuse("Output/Space error", "Set it to false");
    check_formats(scene.output, refuse);
    if (!scene.mesh.carried.empty())
      refuse("Mesh/Carry", "Leave it empty");
    for (const HandleParameters &handle : scene.handles)
      if (!handle.follow_cache.empty())
        refuse("Handles/" + handle.name + "/Follow cache", "Set Motion or Follow pose");
  }

  BodyInputs
  read_shared_body(const CompleteScene &scene,
                   const MPI_Comm       communicator,
                   const Announce      &announce)
  {
    check_shareable(scene);
    UndividedInputs undivided;
    Parcel          parcel = dealii::Utilities::MPI::this_mpi_process(communicator) == 0
                                 ? distribute(scene, communicator, announce, undivided)
                                 : receive(communicator);
    if (!parcel.error.empty())
      throw UserError(parcel.error);
    parcel.mesh.exchange
        = std::make_shared<const MpiExchange>(communicator, std::move(parcel.nodes));
    return { Mesh(std::move(parcel.mesh), scene.mesh.name(), scene.mesh.scale),
             std::move(parcel.fields), std::move(undivided) };
  }
} // namespace Exemplar
