// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/arrays_to_python.h>
#include <exemplar/python/evaluation.h>
#include <exemplar/python/module_parts.h>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    CellMeans
    cells_at_state(HeldProblem &held, const std::string &what)
    {
      CellMeans means;
      ask(held, what, [&](Laboratory &lab) { means = lab.cell_means(lab.here()); });
      return means;
    }

    py::array
    tensors(const std::vector<Matrix3<double>> &of_cells)
    {
      return array_of(of_cells, { py::ssize_t(of_cells.size()), 3, 3 });
    }

    py::array
    example_strains(HeldProblem &held)
    {
      std::vector<Matrix3<double>> strains;
      ask(held, "example_strains", [&](Laboratory &lab) { strains = lab.example_strains(); });
      const auto m = static_cast<py::ssize_t>(held.get().body.mesh.n_cells());
      return array_of(strains, { py::ssize_t(strains.size()) / m, m, 3, 3 });
    }

    py::array
    shape_gradients(const HeldProblem &held)
    {
      const FESpace      &fe_space = held.get().body.fe_space;
      std::vector<double> numbers;
      if (fe_space.is_shell())
        throw UserError("shape_gradients: the triangles of a shell (Mesh/Kind) have none.");
      for (unsigned int point = 0; point < fe_space.n_points(); ++point)
        for (const Vector3<double> &gradient : fe_space.gradients(point))
          for (int c = 0; c < 3; ++c)
            numbers.push_back(gradient[c]);
      const auto m     = static_cast<py::ssize_t>(fe_space.n_cells());
      const auto nodes = static_cast<py::ssize_t>(fe_space.nodes(0).size());
      const auto q     = static_cast<py::ssize_t>(fe_space.n_points()) / m;
      return array_of(std::move(numbers), q == 1 ? Shape{ m, nodes, 3 } : Shape{ m, q, nodes, 3 });
    }

    py::array
    cell_nodes(const HeldProblem &held)
    {
      const FESpace            &fe_space = held.get().body.fe_space;
      std::vector<unsigned int> numbers;
      for (unsigned int cell = 0; cell < fe_space.n_cells(); ++cell)
        for (const unsigned int node : fe_space.nodes(cell))
          numbers.push_back(node);
      const auto m = static_cast<py::ssize_t>(fe_space.n_cells());
      const auto n = static_cast<py::ssize_t>(numbers.size());
      return array_of(std::move(numbers), { m, n / m });
    }
  } // namespace

  void
  add_cell_arrays(ProblemClass &problem)
  {
    problem.def_property_readonly(
        "strains",
        [](HeldProblem &held) { return tensors(cells_at_state(held, "strains").strains); },
        "Strains (m, 3, 3) [-] of the cells at the state, by Model/Strain: of corotational ones "
        "S - I,\n"
        "in the frame that the rotation has turned. Means over the cell. A copy.");
    problem.def_property_readonly(
        "stresses",
        [](HeldProblem &held) { return tensors(cells_at_state(held, "stresses").stresses); },
        "Stresses (m, 3, 3) [Pa] of the cells at the state, in space: R T R^T with the "
        "corotated\n"
        "T = C:(e - eta E(w)) and a patch's pressure. Means over the cell. A copy.");
    problem.def_property_readonly(
        "det_F",
        [](HeldProblem &held)
        {
          std::vector<double> det_F = cells_at_state(held, "det_F").det_F;
          const auto          m     = static_cast<py::ssize_t>(det_F.size());
          return array_of(std::move(det_F), { m });
        },
        "Ratios of volumes (m,) of the cells at the state; with P2 the least of a cell. A copy.");
    problem.def_property_readonly(
        "example_strains", &example_strains,
        "What the examples ask of the cells, (examples, m, 3, 3) [-]: eta E_i, the rest pose\n"
        "(zeros) first if it is one. A copy.");
    problem.def_property_readonly(
        "shape_gradients", &shape_gradients,
        "Gradients of the shape functions (m, 4, 3) [1/m] by cell and its node of cell_nodes; "
        "with\n"
        "Element = P2 (m, 4, 10, 3), at four points of the cell. A copy.");
    problem.def_property_readonly(
        "cell_nodes", &cell_nodes,
        "Nodes (m, 4) of the cells, from 0; with Element = P2 (m, 10), with the middles of edges;\n"
        "uint32, a copy.");
  }
} // namespace Exemplar::Python
