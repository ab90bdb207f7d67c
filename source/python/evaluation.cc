// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/evaluation.h>
#include <exemplar/python/from_python.h>

#include <fmt/core.h>

#include <cmath>
#include <utility>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    using Shape = std::vector<py::ssize_t>;

    /// An array that keeps the memory of a vector.
    template <typename Number>
    py::array
    array_of(std::vector<Number> numbers, Shape shape)
    {
      auto *const       kept = new std::vector<Number>(std::move(numbers));
      const py::capsule owner(kept,
                              [](void *old) { delete static_cast<std::vector<Number> *>(old); });
      return py::array_t<Number>(std::move(shape), kept->data(), owner);
    }

    py::array
    array_of(const std::vector<Matrix3<double>> &matrices, Shape shape)
    {
      std::vector<double> numbers;
      numbers.reserve(9 * matrices.size());
      for (const Matrix3<double> &matrix : matrices)
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j)
            numbers.push_back(matrix[i][j]);
      return array_of(std::move(numbers), std::move(shape));
    }

    py::array
    array_of(const dealii::FullMatrix<double> &matrix)
    {
      std::vector<double> numbers;
      for (unsigned int i = 0; i < matrix.m(); ++i)
        for (unsigned int j = 0; j < matrix.n(); ++j)
          numbers.push_back(matrix(i, j));
      return array_of(std::move(numbers), { py::ssize_t(matrix.m()), py::ssize_t(matrix.n()) });
    }

    py::module_
    scipy(const char *name)
    {
      try
      {
        return py::module_::import(name);
      }
      catch (py::error_already_set &error)
      {
        if (!error.matches(PyExc_ImportError))
          throw;
        py::raise_from(error, PyExc_ImportError,
                       "Sparse matrices need scipy, which this Python cannot import. Install it "
                       "(Debian: apt-get install python3-scipy; elsewhere: pip install scipy).");
        throw py::error_already_set();
      }
    }

    py::object
    sparse_array(RowMatrix matrix)
    {
      const auto n      = static_cast<py::ssize_t>(matrix.row_start.size()) - 1;
      const auto length = static_cast<py::ssize_t>(matrix.column.size());
      const auto parts  = py::make_tuple(array_of(std::move(matrix.value), { length }),
                                         array_of(std::move(matrix.column), { length }),
                                         array_of(std::move(matrix.row_start), { n + 1 }));
      py::object sparse
          = scipy("scipy.sparse").attr("csr_array")(parts, py::arg("shape") = py::make_tuple(n, n));
      sparse.attr("has_canonical_format") = true; // which scipy would look for
      return sparse;
    }

    std::vector<double>
    weights_of(const py::object &object, const std::string &what, const std::size_t n)
    {
      std::vector<double> numbers
          = n == 0 ? std::vector<double>() : numbers_of(object, what + ": weights", py::ssize_t(n));
      if (numbers.size() != n
          || py::array::ensure(object).size() != static_cast<py::ssize_t>(n)) // one for all
        throw UserError(fmt::format(
            "{}: weights must be an array of shape ({},), as problem.weights, but is {}.", what, n,
            description(object)));
      return numbers;
    }

    /// None is what the state has.
    Place
    place_of(const HeldProblem &held,
             const py::object  &positions,
             const py::object  &weights,
             const std::string &what)
    {
      const Problem &problem = held.get();
      Place          at{ problem.state.positions, problem.state.weights };
      if (!positions.is_none())
      {
        const auto rows = points_of(positions, what + ": positions",
                                    py::ssize_t(problem.body.fe_space.n_nodes()));
        for (unsigned int dof = 0; dof < at.positions.size(); ++dof)
          at.positions[dof] = rows[dof / 3][dof % 3];
      }
      if (!weights.is_none())
        at.weights = weights_of(weights, what, at.weights.size());
      return at;
    }

    Tangent
    kind_of(const py::object &object, const std::string &what)
    {
      const std::string kind
          = py::isinstance<py::str>(object) ? text_of(object, what + ": kind") : "";
      if (kind != "exact" && kind != "convex")
        throw UserError(what + ": kind is " + std::string(py::repr(object))
                        + ", but must be 'exact' or 'convex'.");
      return kind == "exact" ? Tangent::exact : Tangent::convex;
    }

    /// Ask the problem's laboratory without Python's lock.
    template <typename Function>
    void
    ask(HeldProblem &held, const std::string &what, const Function &function)
    {
      held.change(what, [&function](Problem &problem) { function(problem.laboratory()); });
    }

    double
    energy(HeldProblem &held, const py::object &positions, const py::object &weights)
    {
      const Place at  = place_of(held, positions, weights, "energy");
      double      phi = 0.;
      ask(held, "energy()", [&](Laboratory &lab) { phi = lab.evaluate(at).potential; });
      return phi;
    }

    py::array
    gradient(HeldProblem &held, const py::object &positions, const py::object &weights)
    {
      const Place         at = place_of(held, positions, weights, "gradient");
      std::vector<double> numbers;
      ask(held, "gradient()",
          [&](Laboratory &lab)
          {
            const Vector &field = lab.evaluate(at).gradient;
            numbers.assign(field.begin(), field.end());
          });
      const auto n = static_cast<py::ssize_t>(numbers.size() / 3);
      return array_of(std::move(numbers), { n, 3 });
    }

    py::array
    weight_gradient(HeldProblem &held, const py::object &positions, const py::object &weights)
    {
      const Place         at = place_of(held, positions, weights, "weight_gradient");
      std::vector<double> numbers;
      ask(held, "weight_gradient()", [&](Laboratory &lab) { numbers = lab.weight_gradient(at); });
      const auto k = static_cast<py::ssize_t>(numbers.size());
      return array_of(std::move(numbers), { k });
    }

    py::object
    hessian(HeldProblem      &held,
            const py::object &positions,
            const py::object &weights,
            const py::object &kind)
    {
      scipy("scipy.sparse"); // before the work
      const Place   at      = place_of(held, positions, weights, "hessian");
      const Tangent tangent = kind_of(kind, "hessian");
      RowMatrix     matrix;
      ask(held, "hessian()", [&](Laboratory &lab) { matrix = lab.hessian(at, tangent); });
      return sparse_array(std::move(matrix));
    }

    py::array
    coupling(HeldProblem      &held,
             const py::object &positions,
             const py::object &weights,
             const py::object &kind)
    {
      const Place         at      = place_of(held, positions, weights, "coupling");
      const Tangent       tangent = kind_of(kind, "coupling");
      std::vector<double> columns;
      ask(held, "coupling()", [&](Laboratory &lab) { columns = lab.coupling(at, tangent); });
      const auto k = static_cast<py::ssize_t>(at.weights.size());
      const auto n = static_cast<py::ssize_t>(at.positions.size());
      return py::array(array_of(std::move(columns), { k, n }).attr("T"));
    }

    py::array
    weight_hessian(HeldProblem &held)
    {
      dealii::FullMatrix<double> H;
      ask(held, "weight_hessian()", [&](Laboratory &lab) { H = lab.weight_hessian(); });
      return array_of(H);
    }

    /// A - G P G^T.
    py::object
    reduced_hessian(HeldProblem      &held,
                    const py::object &positions,
                    const py::object &weights,
                    const py::object &kind)
    {
      const py::object A  = hessian(held, positions, weights, kind);
      const Place      at = place_of(held, positions, weights, "reduced_hessian");
      py::cpp_function times([A](const py::object &x) { return A.attr("__matmul__")(x); });
      if (held.get().examples.weights.n_unknown() > 0)
      {
        const py::object           G = coupling(held, positions, weights, kind);
        dealii::FullMatrix<double> compliance;
        ask(held, "reduced_hessian()",
            [&](Laboratory &lab) { compliance = lab.weight_compliance(at); });
        const py::object P = array_of(compliance);
        times              = py::cpp_function(
            [A, G, P](const py::object &x)
            {
              const py::object of_weights = P.attr("__matmul__")(G.attr("T").attr("__matmul__")(x));
              return A.attr("__matmul__")(x).attr("__sub__")(G.attr("__matmul__")(of_weights));
            });
      }
      return scipy("scipy.sparse.linalg")
          .attr("LinearOperator")(A.attr("shape"), py::arg("matvec") = times,
                                  py::arg("rmatvec") = times, py::arg("matmat") = times,
                                  py::arg("rmatmat") = times,
                                  py::arg("dtype")   = py::dtype::of<double>());
    }

    py::object
    mass(HeldProblem &held)
    {
      scipy("scipy.sparse");
      RowMatrix matrix;
      held.change("mass", [&](Problem &problem) { matrix = mass_matrix(problem); });
      return sparse_array(std::move(matrix));
    }

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

    void
    add_potential(ProblemClass &problem)
    {
      const auto none = py::none();
      problem.def(
          "energy", &energy, py::arg("positions") = none, py::arg("weights") = none,
          "energy(positions=None, weights=None) -> float\n\n"
          "The incremental potential Phi [J] of doc/dynamics.md, which the next step of a dynamic\n"
          "scene minimises: with inertia, damping and the loads at that step's end. Otherwise "
          "energy\n"
          "and loads at the present time.\n"
          "positions: (n, 3) [m], with Element = P2 the middles of edges, too, as in final.msh "
          "with\n"
          "Final pose = quadratic. weights: (k,), as problem.weights. None: those of the state. "
          "No\n"
          "weights are minimised again, and nothing of the problem changes. Raises UserError for\n"
          "other shapes, and RuntimeError within a step. Other Python threads run meanwhile.");
      problem.def("gradient", &gradient, py::arg("positions") = none, py::arg("weights") = none,
                  "gradient(positions=None, weights=None) -> (n, 3)\n\n"
                  "d Phi/dx [N] by all nodes, held ones included: there what the handles must "
                  "hold.\n"
                  "Arguments and errors as of energy(). With Gradient = frozen it is the paper's "
                  "force,\n"
                  "which is no gradient.");
      problem.def("weight_gradient", &weight_gradient, py::arg("positions") = none,
                  py::arg("weights") = none,
                  "weight_gradient(positions=None, weights=None) -> (k,)\n\n"
                  "d Phi/dw [J], kinks of Examples/Yield aside. Arguments and errors as of "
                  "energy();\n"
                  "UserError, too, where no weight is unknown.");
      problem.def(
          "hessian", &hessian, py::arg("positions") = none, py::arg("weights") = none,
          py::arg("kind") = "exact",
          "hessian(positions=None, weights=None, kind='exact') -> scipy.sparse.csr_array (3n, "
          "3n)\n\n"
          "d2 Phi/dx2 [N/m] by all degrees of freedom 3 i + c, held ones included; kind='convex' "
          "is\n"
          "what the solver takes where that is indefinite. Outer products of patches are in it.\n"
          "Arguments and errors as of energy(); ImportError without scipy.");
      problem.def("coupling", &coupling, py::arg("positions") = none, py::arg("weights") = none,
                  py::arg("kind") = "exact",
                  "coupling(positions=None, weights=None, kind='exact') -> (3n, k)\n\n"
                  "G = -d2 Phi/dx dw [N] of doc/solver.md, Eq. (10). Zero for the rest pose. "
                  "Arguments\n"
                  "and errors as of weight_gradient().");
      problem.def("weight_hessian", &weight_hessian,
                  "weight_hessian() -> (k, k)\n\n"
                  "H = d2 Phi/dw2 [J] of doc/model.md, Eq. (9), which is the same everywhere. "
                  "Raises\n"
                  "UserError where no weight is unknown.");
      problem.def(
          "reduced_hessian", &reduced_hessian, py::arg("positions") = none,
          py::arg("weights") = none, py::arg("kind") = "exact",
          "reduced_hessian(positions=None, weights=None, kind='exact')\n"
          "    -> scipy.sparse.linalg.LinearOperator (3n, 3n)\n\n"
          "x -> A x - G P G^T x, the matrix reduced by the weights, which is dense: weights above\n"
          "their bounds follow the positions (by P x G^T), their sums held; others stay. Where no\n"
          "weight is unknown it is hessian(). Arguments and errors as of hessian().");
      problem.def_property_readonly("mass", &mass,
                                    "Mass matrix [kg], scipy.sparse.csr_array (3n, 3n); in static "
                                    "scenes, too. A copy.");
    }

    void
    add_cells(ProblemClass &problem)
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
          "Nodes (m, 4) of the cells; with Element = P2 (m, 10), with the middles of edges. A "
          "copy.");
    }
  } // namespace

  void
  add_evaluation(ProblemClass &problem)
  {
    add_potential(problem);
    add_cells(problem);
    for (const char *name : { "energy", "gradient", "weight_gradient" })
      refuse_other_arguments(
          problem, name, fmt::format("{0} is called as {0}(positions=None, weights=None).", name));
    for (const char *name : { "hessian", "coupling", "reduced_hessian" })
      refuse_other_arguments(
          problem, name,
          fmt::format("{0} is called as {0}(positions=None, weights=None, kind='exact').", name));
    refuse_other_arguments(problem, "weight_hessian", "weight_hessian() takes no argument.");
  }
} // namespace Exemplar::Python
