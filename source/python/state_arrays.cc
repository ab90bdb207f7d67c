// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/state_arrays.h>

#include <utility>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    /// A read-only array in memory that `owner` keeps.
    template <typename Number>
    py::array
    read_only_rows(const Number     *memory,
                   const std::size_t n,
                   const py::ssize_t width,
                   py::object        owner)
    {
      py::array_t<Number> rows({ py::ssize_t(n), width }, memory, std::move(owner));
      rows.attr("flags").attr("writeable") = false;
      return rows;
    }

    /// A Python object that shares ownership with `pointer`.
    template <typename T>
    py::capsule
    keeper(std::shared_ptr<T> pointer)
    {
      return py::capsule(new std::shared_ptr<T>(std::move(pointer)),
                         [](void *kept) { delete static_cast<std::shared_ptr<T> *>(kept); });
    }
  } // namespace

  StateArrays::StateArrays(std::shared_ptr<Problem> problem) : problem(std::move(problem)) {}

  void
  StateArrays::let_go()
  {
    let_go(problem->state.positions, shown_positions);
    let_go(problem->state.velocities, shown_velocities);
  }

  void
  StateArrays::let_go(Vector &field, std::shared_ptr<Shown> &shown)
  {
    if (shown.use_count() > 1)
    {
      shown->memory.swap(field);
      field = shown->memory;
    }
    shown.reset();
  }

  py::array
  StateArrays::show(const Vector &field, std::shared_ptr<Shown> &shown, const bool in_step)
  {
    const std::size_t n_nodes = problem->body.mesh.n_nodes(); // without the middles of edges
    if (in_step)                                              // the step will free this memory
      return py::array_t<double>({ py::ssize_t(n_nodes), py::ssize_t(3) }, field.begin());
    if (shown == nullptr)
      shown = std::make_shared<Shown>();
    // the memory is of the problem until a step leaves it to the array
    return read_only_rows(
        field.begin(), n_nodes, 3,
        keeper(std::make_shared<std::pair<std::shared_ptr<Problem>, std::shared_ptr<Shown>>>(
            problem, shown)));
  }

  py::array
  StateArrays::positions(const bool in_step)
  {
    return show(problem->state.positions, shown_positions, in_step);
  }

  py::object
  StateArrays::velocities(const bool in_step)
  {
    const Vector &field = problem->state.velocities;
    return field.size() == 0 ? py::object(py::none()) : show(field, shown_velocities, in_step);
  }

  py::array
  StateArrays::rest_positions() const
  {
    const auto &nodes = problem->body.mesh.get_nodes();
    static_assert(sizeof(nodes[0]) == 3 * sizeof(double));
    return read_only_rows(&nodes[0][0], nodes.size(), 3, keeper(problem));
  }

  py::array
  StateArrays::cells() const
  {
    const Mesh &mesh = problem->body.mesh;
    return read_only_rows(mesh.corners(0).data(), mesh.n_cells(), mesh.corners(0).size(),
                          keeper(problem));
  }
} // namespace Exemplar::Python
