// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/mpi_exchange.h>
#include <exemplar/base/errors.h>
#include <exemplar/body/patches.h>
#include <exemplar/mesh/mesh.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/mesh/mesh_edges.h>
#include <exemplar/run/inputs/shared_inputs.h>
#include <exemplar/run/inputs/surface_readings.h>
#include <exemplar/run/scene/scene_parameters.h>

#include <boost/archive/binary_iarchive.hpp>
#include <boost/archive/binary_oarchive.hpp>
#include <boost/serialization/array.hpp>
#include <boost/serialization/map.hpp>
#include <boost/serialization/set.hpp>
#include <boost/serialization/string.hpp>
#include <boost/serialization/utility.hpp>
#include <boost/serialization/vector.hpp>
#include <deal.II/base/mpi.h>
#include <deal.II/lac/sparsity_pattern.h>
#include <deal.II/lac/sparsity_tools.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <sstream>

namespace Exemplar
{
  /// boost finds it by this name.
  template <typename Archive>
  void
  serialize(Archive &archive, BoundaryFace &face, const unsigned int)
  {
    archive &face.nodes &face.boundary_id;
  }

  template <typename Archive>
  void
  serialize(Archive &archive, PaintedConstant &constant, const unsigned int)
  {
    archive &constant.values &constant.is_factor;
  }

  namespace
  {
    constexpr int message_tag = 16;

    /// A process' part on its way.
    struct Parcel
    {
      std::string error; ///< why there is none; empty: all is well
      SharedNodes nodes;
      SharedBody  body;
      NamedPoses  poses;
      NamedNodes  selections;

      template <typename Archive>
      void
      serialize(Archive &archive, unsigned int /*version*/)
      {
        MeshArrays                   &mesh = body.mesh.arrays;
        archive &error &nodes &poses &selections;
        archive &body.mesh.whole &body.mesh.cells_in_file &body.patches &body.shares;
        archive &body.material.youngs_modulus &body.material.poissons_ratio &body.material.density;
        archive &mesh.contents.node_numbers &mesh.contents.nodes &mesh.contents.physical_names;
        archive &mesh.cells &mesh.material_ids &mesh.element_numbers &mesh.boundary_faces;
        bool     has_support = body.support.has_value();
        archive &has_support;
        if (!has_support)
          return;
        if (!body.support)
          body.support.emplace();
        archive &body.support->corners &body.support->rest &body.support->nodes &body.support
            ->held_dofs;
      }
    };

    std::string
    packed(const Parcel &parcel)
    {
      std::ostringstream bytes;
      {
        boost::archive::binary_oarchive archive(bytes);
        archive                        &parcel;
      }
      return bytes.str();
    }

    void
    send(const Parcel &parcel, const unsigned int process, const MPI_Comm communicator)
    {
      const std::string  bytes = packed(parcel);
      unsigned long long size  = bytes.size();
      MPI_Send(&size, 1, MPI_UNSIGNED_LONG_LONG, static_cast<int>(process), message_tag,
               communicator);
      constexpr std::size_t maximum = std::numeric_limits<int>::max();
      for (std::size_t first = 0; first < bytes.size(); first += maximum)
        MPI_Send(bytes.data() + first, static_cast<int>(std::min(maximum, bytes.size() - first)),
                 MPI_CHAR, static_cast<int>(process), message_tag, communicator);
    }

    Parcel
    receive(const MPI_Comm communicator)
    {
      unsigned long long size = 0;
      MPI_Recv(&size, 1, MPI_UNSIGNED_LONG_LONG, 0, message_tag, communicator, MPI_STATUS_IGNORE);
      std::string           bytes(size, '\0');
      constexpr std::size_t maximum = std::numeric_limits<int>::max();
      for (std::size_t first = 0; first < bytes.size(); first += maximum)
        MPI_Recv(bytes.data() + first, static_cast<int>(std::min(maximum, bytes.size() - first)),
                 MPI_CHAR, 0, message_tag, communicator, MPI_STATUS_IGNORE);
      std::istringstream              in(bytes);
      boost::archive::binary_iarchive archive(in);
      Parcel                          parcel;
      archive                        &parcel;
      return parcel;
    }

    /// Chooses the part of each process, and makes the parcels. Nodes are those of the file and, of
    /// quadratic elements, those on edges behind them, as FESpace has them.
    class Distributor
    {
    public:
      Distributor(const SceneParameters &scene, Inputs &inputs, const unsigned int n_processes)
          : inputs(inputs), mesh(std::move(inputs.mesh), scene.mesh.name(), scene.mesh.scale),
            readings(read_off_surface(scene, mesh, inputs)),
            is_quadratic(scene.model.element == Element::P2)
      {
        select(scene);
        if (scene.scene == SceneKind::interpolation)
          support = support_near_centroid(mesh.get_nodes(), mesh.get_cells());
        if (is_quadratic)
          edges = edges_of(mesh.get_cells());
        else
          check_poses();
        if (scene.model.has_patches() && !is_quadratic)
          patches = Patches::stars(mesh.get_cells(), mesh.n_nodes(), mesh.get_material_ids(),
                                   Material(scene.material, mesh.get_material_ids(),
                                            mesh.get_contents(), readings.material));
        const std::vector<CellFace> faces = sorted_faces({ mesh.get_cells(), {}, {} });
        partition(n_processes, faces);
        share_nodes(n_processes);
        give_faces(faces);
      }

      Parcel
      parcel(const unsigned int process) const
      {
        const std::vector<unsigned int> &cells      = cells_of[process];
        const std::vector<unsigned int> &nodes      = nodes_of[process];
        const auto                       n_vertices = static_cast<unsigned int>(
            std::lower_bound(nodes.begin(), nodes.end(), mesh.n_nodes()) - nodes.begin());
        const std::vector<unsigned int> vertices(nodes.begin(), nodes.begin() + n_vertices);
        const auto                      here = [&](const unsigned int node)
        {
          const auto found = std::lower_bound(vertices.begin(), vertices.end(), node);
          return static_cast<unsigned int>(found - vertices.begin());
        };

        Parcel result;
        result.nodes.in_files      = nodes;
        result.nodes.numbers       = chosen(numbers, nodes);
        result.nodes.first_numbers = first_numbers;

        const MshFile &file         = mesh.get_contents();
        MeshPart      &part         = result.body.mesh;
        MeshArrays    &own          = part.arrays;
        part.whole                  = mesh.whole();
        part.cells_in_file          = cells;
        own.contents.nodes          = chosen(file.nodes, vertices);
        own.contents.node_numbers   = chosen(file.node_numbers, vertices);
        own.contents.physical_names = file.physical_names;
        own.material_ids            = chosen(mesh.get_material_ids(), cells);
        for (const unsigned int cell : cells)
        {
          own.cells.push_back(mesh.get_cells()[cell]);
          std::transform(own.cells.back().begin(), own.cells.back().end(), own.cells.back().begin(),
                         here);
          own.element_numbers.push_back(mesh.element_number(cell));
        }
        for (const unsigned int face : faces_of[process])
        {
          BoundaryFace own_face = mesh.get_boundary_faces()[face];
          std::transform(own_face.nodes.begin(), own_face.nodes.end(), own_face.nodes.begin(),
                         here);
          own.boundary_faces.push_back(own_face);
        }
        if (!patches.empty())
          result.body.patches = without_gaps(chosen(patches, cells));
        result.body.support  = support;
        result.body.material = readings.material;
        for (PaintedConstant *constant :
             { &result.body.material.youngs_modulus, &result.body.material.poissons_ratio,
               &result.body.material.density })
          if (!constant->values.empty())
            constant->values = chosen(constant->values, cells);
        for (const std::vector<double> &share : readings.shares)
          result.body.shares.push_back(chosen(share, cells));
        for (const auto &[name, places] : inputs.poses)
          result.poses[name]
              = chosen(places, is_quadratic && places.size() > mesh.n_nodes() ? nodes : vertices);
        for (const auto &[text, all] : selections)
          for (const unsigned int node : all)
            if (std::binary_search(vertices.begin(), vertices.end(), node))
              result.selections[text].push_back(here(node));
        return result;
      }

      /// What the root keeps, when all have their parcels.
      void
      finish(Parcel &of_root)
      {
        std::vector<std::string> &warnings = of_root.body.mesh.arrays.warnings;
        warnings                           = mesh.get_warnings();
        warnings.insert(warnings.end(), readings.warnings.begin(), readings.warnings.end());
        of_root.body.mesh.contents_of_whole
            = std::make_shared<const MshFile>(std::move(mesh).take_contents());
      }

    private:
      template <typename T>
      static std::vector<T>
      chosen(const std::vector<T> &all, const std::vector<unsigned int> &indices)
      {
        std::vector<T> some;
        some.reserve(indices.size());
        for (const unsigned int i : indices)
          some.push_back(all[i]);
        return some;
      }

      static std::vector<unsigned int>
      without_gaps(std::vector<unsigned int> numbers_with_gaps)
      {
        std::vector<unsigned int> present = numbers_with_gaps;
        std::sort(present.begin(), present.end());
        present.erase(std::unique(present.begin(), present.end()), present.end());
        for (unsigned int &number : numbers_with_gaps)
          number = static_cast<unsigned int>(
              std::lower_bound(present.begin(), present.end(), number) - present.begin());
        return numbers_with_gaps;
      }

      /// The nodes of all selections by their text.
      void
      select(const SceneParameters &scene)
      {
        inputs.nodes.insert(readings.nodes.begin(), readings.nodes.end());
        const auto add = [&](const Selection &selection, const std::string &key)
        {
          if (selection.is_boundary())
            selection.faces(mesh, key); // are there any?
          selections[selection.text] = selection.nodes(mesh, key, inputs.nodes);
        };
        for (const HandleParameters &handle : scene.handles)
          add(handle.select, "Handles/" + handle.name);
        for (const LoadParameters &load : scene.loads.named)
          add(load.select, "Loads/" + load.name);
      }

      /// Linear elements leave places of the middles of edges away.
      void
      check_poses() const
      {
        for (const auto &[name, places] : inputs.poses)
          if (places.size() > mesh.n_nodes())
            check_straight(places, edges_of(mesh.get_cells()), mesh.diameter() / mesh.get_scale(),
                           name);
      }

      /// The graph of what stays whole, patches or cells: an edge where two share a face.
      static dealii::SparsityPattern
      dual_graph(const std::vector<CellFace>     &faces,
                 const std::vector<unsigned int> &lump_of_cell,
                 const unsigned int               n_lumps)
      {
        std::vector<unsigned int> row_lengths(n_lumps, 1); // and the diagonal
        std::vector<std::pair<std::size_t, std::size_t>> edges;
        for (std::size_t i = 1; i < faces.size(); ++i)
          if (faces[i].nodes == faces[i - 1].nodes)
          {
            const unsigned int a = lump_of_cell[faces[i - 1].cell], b = lump_of_cell[faces[i].cell];
            if (a == b)
              continue;
            edges.emplace_back(a, b);
            ++row_lengths[a];
            ++row_lengths[b];
          }
        dealii::SparsityPattern pattern(n_lumps, n_lumps, row_lengths);
        for (const auto &[a, b] : edges)
        {
          pattern.add(a, b);
          pattern.add(b, a);
        }
        pattern.compress();
        return pattern;
      }

      /// Which cells, and which faces of the boundary, a process gets.
      void
      partition(const unsigned int n_processes, const std::vector<CellFace> &faces)
      {
        std::vector<unsigned int> lumps = patches;
        if (lumps.empty())
        {
          lumps.resize(mesh.n_cells());
          std::iota(lumps.begin(), lumps.end(), 0u);
        }
        const unsigned int        n_lumps = 1 + *std::max_element(lumps.begin(), lumps.end());
        std::vector<unsigned int> weights(n_lumps, 0), process_of(n_lumps, 0);
        for (const unsigned int lump : lumps)
          ++weights[lump];
        if (n_processes <= n_lumps)
          dealii::SparsityTools::partition(dual_graph(faces, lumps, n_lumps), weights, n_processes,
                                           process_of);
        cells_of.resize(n_processes);
        for (unsigned int cell = 0; cell < mesh.n_cells(); ++cell)
          cells_of[process_of[lumps[cell]]].push_back(cell);
        for (const auto &cells : cells_of)
          if (cells.empty())
            throw UserError(mesh.get_name() + ": " + std::to_string(n_processes)
                            + " processes are more than its " + std::to_string(mesh.n_cells())
                            + " cells are enough for"
                            + (patches.empty() ? "" : " in patches that stay whole")
                            + ". Start fewer with mpirun -n.");
      }

      /// Which nodes a process gets: all of its cells. Of a node that several have, one is the owner,
      /// by turns.
      void
      share_nodes(const unsigned int n_processes)
      {
        const std::size_t         n_nodes = mesh.n_nodes() + edges.size();
        std::vector<unsigned int> n_sharers(n_nodes, 0), n_seen(n_nodes, 0);
        nodes_of.resize(n_processes);
        for (unsigned int process = 0; process < n_processes; ++process)
        {
          std::vector<unsigned int> &nodes = nodes_of[process];
          for (const unsigned int cell : cells_of[process])
          {
            const auto &corners = mesh.get_cells()[cell];
            nodes.insert(nodes.end(), corners.begin(), corners.end());
            for (const auto &[a, b] : cell_edges)
              if (is_quadratic)
                nodes.push_back(mesh.n_nodes() + find_edge(edges, corners[a], corners[b]));
          }
          std::sort(nodes.begin(), nodes.end());
          nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
          for (const unsigned int node : nodes)
            ++n_sharers[node];
        }
        numbers.resize(n_nodes);
        first_numbers = { 0 };
        for (const std::vector<unsigned int> &nodes : nodes_of)
        {
          unsigned int next = first_numbers.back();
          for (const unsigned int node : nodes)
            if (n_seen[node]++ == node % n_sharers[node])
              numbers[node] = next++;
          first_numbers.push_back(next);
        }
      }

      void
      give_faces(const std::vector<CellFace> &faces)
      {
        std::vector<unsigned int> process_of_cell(mesh.n_cells());
        for (unsigned int process = 0; process < cells_of.size(); ++process)
          for (const unsigned int cell : cells_of[process])
            process_of_cell[cell] = process;
        faces_of.resize(cells_of.size());
        const auto ascending = [](std::array<unsigned int, 3> nodes)
        {
          std::sort(nodes.begin(), nodes.end());
          return nodes;
        };
        std::map<std::array<unsigned int, 3>, unsigned int> number;
        for (unsigned int face = 0; face < mesh.get_boundary_faces().size(); ++face)
          number[ascending(mesh.get_boundary_faces()[face].nodes)] = face;
        for (const CellFace &face : faces)
          if (const auto found = number.find(face.nodes); found != number.end())
            faces_of[process_of_cell[face.cell]].push_back(found->second);
        for (std::vector<unsigned int> &of_process : faces_of)
          std::sort(of_process.begin(), of_process.end());
      }

      Inputs                                     &inputs;
      Mesh                                        mesh;
      const SurfaceReadings                       readings;
      const bool                                  is_quadratic;
      NamedNodes                                  selections;
      std::optional<StaticallyDeterminateSupport> support;
      std::vector<std::array<unsigned int, 2>>    edges;         ///< of quadratic elements
      std::vector<unsigned int>                   patches;       ///< of cells; empty: none
      std::vector<std::vector<unsigned int>>      cells_of;      ///< of each process, ascending
      std::vector<std::vector<unsigned int>>      faces_of;      ///< the same
      std::vector<std::vector<unsigned int>>      nodes_of;      ///< the same
      std::vector<unsigned int>                   numbers;       ///< SharedNodes::numbers of all
      std::vector<unsigned int>                   first_numbers; ///< SharedNodes::first_numbers
    };

    void
    send_to_all_others(const Parcel &parcel, const MPI_Comm communicator)
    {
      for (unsigned int process = 1;
           process < dealii::Utilities::MPI::n_mpi_processes(communicator); ++process)
        send(parcel, process, communicator);
    }

    /// What the root does: read, send all others their parts, and keep its own.
    Parcel
    distribute(const SceneParameters &scene,
               Inputs                &inputs,
               const MPI_Comm         communicator,
               const Announce        &announce)
    {
      try
      {
        inputs                         = read_inputs(scene, {}, announce);
        const unsigned int n_processes = dealii::Utilities::MPI::n_mpi_processes(communicator);
        Distributor        distributor(scene, inputs, n_processes);
        for (unsigned int process = 1; process < n_processes; ++process)
          send(distributor.parcel(process), process, communicator);
        Parcel own = distributor.parcel(0);
        distributor.finish(own);
        return own;
      }
      catch (const UserError &error)
      {
        Parcel nothing;
        nothing.error = error.what();
        send_to_all_others(nothing, communicator);
        throw;
      }
      catch (const SolverFailure &failure)
      {
        Parcel nothing;
        nothing.error = failure.what();
        send_to_all_others(nothing, communicator);
        throw UserError(failure.what());
      }
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
    if (scene.solver.linear_solver == LinearSolver::cholesky
        || scene.solver.linear_solver == LinearSolver::umfpack)
      refuse("Solver/Linear solver = cholesky or umfpack", "Set it to auto or iterative");
    if (scene.examples.in_use() && scene.examples.weights_per_region
        && scene.examples.region_blend_length > 0.)
      refuse("Examples/Region blend length", "Set it to 0");
    if (scene.output.space_error != SpaceErrorUse::never)
      refuse("Output/Space error", "Set it to false");
    for (const std::string &format : scene.output.formats)
      if (format != "vtu" && scene.output.every > 0)
        refuse("Output/Formats = " + format, "Set it to vtu");
    for (const HandleParameters &handle : scene.handles)
      if (!handle.follow_cache.empty())
        refuse("Handles/" + handle.name + "/Follow cache", "Set Motion or Follow pose");
  }

  Inputs
  read_shared_inputs(const SceneParameters &given,
                     const MPI_Comm         communicator,
                     const Announce        &announce)
  {
    SceneParameters scene = given;
    scene.complete();
    check_shareable(scene);
    Inputs inputs;
    Parcel parcel = dealii::Utilities::MPI::this_mpi_process(communicator) == 0
                        ? distribute(scene, inputs, communicator, announce)
                        : receive(communicator);
    if (!parcel.error.empty())
      throw UserError(parcel.error);
    parcel.body.mesh.exchange
        = std::make_shared<const MpiExchange>(communicator, std::move(parcel.nodes));
    Inputs own;
    own.poses     = std::move(parcel.poses);
    own.nodes     = std::move(parcel.selections);
    own.made      = inputs.made;
    own.geo_walls = inputs.mesh.geo_walls;
    own.shared    = std::make_shared<SharedBody>(std::move(parcel.body));
    return own;
  }
} // namespace Exemplar
