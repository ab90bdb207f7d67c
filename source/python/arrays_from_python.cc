// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/mesh/mesh_checks.h>
#include <exemplar/python/arrays_from_python.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    using Cells = std::vector<std::array<unsigned int, 4>>;

    /// Whether an array has real numbers. numpy would also convert complex numbers (to their real
    /// parts), texts of digits and booleans.
    bool
    has_real_numbers(const py::array &array)
    {
      const char kind = array.dtype().kind();
      return kind == 'f' || kind == 'i' || kind == 'u';
    }

    void
    refuse_mask(const py::handle &object, const std::string &what)
    {
      if (py::hasattr(object, "mask") && py::hasattr(object, "filled"))
        throw UserError(what
                        + " is a masked array, and what is masked would count. Fill it: "
                          "values.filled(0.).");
    }

    /// The rows of an array (n, width), or any number of them where n is negative.
    template <typename Number>
    py::array_t<Number, py::array::c_style | py::array::forcecast>
    rows_of(const py::handle  &object,
            const std::string &what,
            const py::ssize_t  n,
            const py::ssize_t  width)
    {
      const auto any = py::array::ensure(object);
      if (!any || any.ndim() != 2 || any.shape(1) != width || (n >= 0 && any.shape(0) != n))
        throw UserError(fmt::format("{} must be an array of shape ({}, {}), but is {}.", what,
                                    n < 0 ? "n" : fmt::format("{}", n), width,
                                    description(object)));
      refuse_mask(object, what);
      const char kind = any.dtype().kind();
      if (std::is_integral_v<Number> && kind != 'i' && kind != 'u')
        throw UserError(what + " must be an array of integers, but is one of "
                        + std::string(py::str(any.dtype())) + ". Give it as array.astype(int).");
      require_real(any, what);
      return any;
    }

    void
    refuse_other_cells(const py::handle &cells)
    {
      const auto any = py::array::ensure(cells);
      if (any && any.ndim() == 2 && any.shape(1) == 8)
        throw UserError("mesh: cells has 8 nodes a row, as hexahedra have. Only tetrahedra, of 4 "
                        "nodes, are taken: split each hexahedron into tetrahedra.");
      if (any && any.ndim() == 2 && any.shape(1) == 10)
        throw UserError("mesh: cells has 10 nodes a row. Take the corners alone, cells[:, :4], and "
                        "the nodes that these have; Model/Element = P2 puts nodes into the middles "
                        "of edges.");
    }

    /// An index as unsigned int. Refuses negative numbers, which would become large.
    unsigned int
    index_of(const long long value, const std::string &what)
    {
      if (value < 0 || value > std::numeric_limits<unsigned int>::max())
        throw UserError(fmt::format("{} has {}, which is not allowed. Allowed: indices from 0; if "
                                    "1 was subtracted from such ones, add it to all.",
                                    what, value));
      return static_cast<unsigned int>(value);
    }

    /// The indices in an array of integers.
    std::vector<unsigned int>
    indices_of(const py::array &array, const std::string &what)
    {
      const py::array_t<long long, py::array::c_style | py::array::forcecast> numbers = array;
      std::vector<unsigned int>                                               indices;
      for (py::ssize_t i = 0; i < numbers.size(); ++i)
        indices.push_back(index_of(numbers.data()[i], what));
      return indices;
    }

    std::vector<unsigned int>
    material_ids_of(const py::handle &object)
    {
      const auto any  = py::array::ensure(object);
      const char kind = any ? any.dtype().kind() : 'O';
      if (!any || any.ndim() != 1 || (kind != 'i' && kind != 'u'))
      {
        PyErr_Clear();
        throw UserError("mesh: material ids must be an array of integers of shape (m,), but is "
                        + description(object)
                        + (any ? " and type " + std::string(py::str(any.dtype())) : std::string())
                        + ".");
      }
      refuse_mask(object, "mesh: material ids");
      return indices_of(any, "mesh: material ids");
    }

    Cells
    cells_of(const py::handle &object)
    {
      refuse_other_cells(object);
      const auto rows  = rows_of<long long>(object, "mesh: cells", -1, 4);
      const auto nodes = rows.unchecked<2>();
      Cells      cells(nodes.shape(0));
      for (py::ssize_t c = 0; c < nodes.shape(0); ++c)
        for (py::ssize_t v = 0; v < 4; ++v)
          cells[c][v] = index_of(nodes(c, v), "mesh: cells");
      return cells;
    }

    void
    refuse_unused_nodes(const Cells &cells, const std::size_t n_nodes)
    {
      std::vector<bool> used(n_nodes, false);
      for (const auto &cell : cells)
        for (const unsigned int node : cell)
          used[node] = true;
      std::vector<std::size_t> unused;
      for (std::size_t node = 0; node < n_nodes; ++node)
        if (!used[node])
          unused.push_back(node);
      if (!unused.empty() && !cells.empty())
        throw UserError("mesh: no cell has the nodes (counted from 0) " + list_numbers(unused)
                        + ". Leave them out: used, new = np.unique(cells, return_inverse=True); "
                          "nodes, cells = nodes[used], new.reshape(-1, 4).");
    }

    void
    refuse_repeated_cells(const Cells &cells)
    {
      std::vector<std::pair<std::array<unsigned int, 4>, std::size_t>> sorted;
      for (const auto &cell : cells)
      {
        sorted.emplace_back(cell, sorted.size());
        std::sort(sorted.back().first.begin(), sorted.back().first.end());
      }
      std::sort(sorted.begin(), sorted.end());
      const auto twin
          = std::adjacent_find(sorted.begin(), sorted.end(),
                               [](const auto &a, const auto &b) { return a.first == b.first; });
      if (twin != sorted.end())
        throw UserError(
            fmt::format("mesh: cells[{}] has the same nodes as cells[{}]. Remove one of them.",
                        std::next(twin)->second, twin->second));
    }

    void
    refuse_repeated_nodes(const Cells &cells)
    {
      for (std::size_t c = 0; c < cells.size(); ++c)
        for (unsigned int v = 1; v < 4; ++v)
          if (std::find(cells[c].begin(), cells[c].begin() + v, cells[c][v])
              != cells[c].begin() + v)
            throw UserError(fmt::format("mesh: cells[{}] has node {} twice. A tetrahedron has four "
                                        "different nodes: remove the cell, or correct it.",
                                        c, cells[c][v]));
    }

    /// A hint for what `mesh` is by mistake, and how to hand that in.
    std::string
    remedy_for_mesh(const py::object &mesh)
    {
      if (py::hasattr(mesh, "points"))
        return " Of a mesh of meshio take (mesh.points, mesh.cells_dict[\"tetra\"]).";
      if (py::isinstance<py::dict>(mesh))
        return " Of a dictionary take its entries: (mesh[\"nodes\"], mesh[\"cells\"]).";
      return " A file is named by the scene: Mesh/File.";
    }

    void
    refuse_exchanged_parts(const py::tuple &parts)
    {
      const auto nodes = py::array::ensure(parts[0]), cells = py::array::ensure(parts[1]);
      if (!nodes || !cells || nodes.ndim() != 2 || cells.ndim() != 2)
        PyErr_Clear();
      else if (nodes.shape(1) == 4 && cells.shape(1) == 3)
        throw UserError("mesh: nodes has the shape " + std::string(py::str(nodes.attr("shape")))
                        + " and cells " + std::string(py::str(cells.attr("shape")))
                        + ": these seem to be exchanged. Give (nodes (n, 3), cells (m, 4)).");
    }

    /// The parts of a tuple or list.
    py::tuple
    parts_of(const py::object &mesh)
    {
      const bool is_some = py::isinstance<py::iterable>(mesh) && !py::isinstance<py::str>(mesh)
                           && !py::isinstance<py::dict>(mesh);
      const py::tuple parts = is_some ? py::tuple(mesh) : py::tuple();
      if (parts.size() == 2 || parts.size() == 3)
        return parts;
      throw UserError(fmt::format("mesh must be (nodes (n, 3), cells (m, 4)) or (nodes, cells, "
                                  "material ids (m)), but {}.{}",
                                  is_some ? fmt::format("has {} parts", parts.size())
                                          : "is " + description(mesh),
                                  remedy_for_mesh(mesh)));
    }
  } // namespace

  std::string
  description(const py::handle &object)
  {
    const auto array = py::array::ensure(object);
    if (!array || array.ndim() == 0)
      return "a " + std::string(py::str(py::type::of(object).attr("__name__")));
    const std::string of_type
        = has_real_numbers(array) ? "" : " of " + std::string(py::str(array.dtype().attr("name")));
    return "an array" + of_type + " of shape " + std::string(py::str(array.attr("shape")));
  }

  void
  require_real(const py::array &array, const std::string &what)
  {
    if (!has_real_numbers(array))
      throw UserError(
          what + " must be an array of real numbers, but is " + description(array)
          + ". Make one of numbers: numpy.real(values), or numpy.array(values, dtype=float).");
  }

  double
  real_number_of(const py::handle &object, const std::string &what)
  {
    const auto any = py::array::ensure(object);
    // numpy would convert a complex number to its real part, and parse a text
    const bool   may_be_one = !any || std::strchr("fiubO", any.dtype().kind()) != nullptr;
    const double number     = may_be_one ? PyFloat_AsDouble(object.ptr()) : 0.;
    if (may_be_one && PyErr_Occurred() == nullptr)
      return number;
    PyErr_Clear();
    throw py::type_error(what + " must be a number, but is " + description(object) + ".");
  }

  std::vector<dealii::Point<3>>
  points_of(const py::handle &object, const std::string &what, const py::ssize_t n)
  {
    const auto                    rows = rows_of<double>(object, what, n, 3);
    const auto                    x    = rows.unchecked<2>();
    std::vector<dealii::Point<3>> points;
    for (py::ssize_t i = 0; i < x.shape(0); ++i)
    {
      if (!std::isfinite(x(i, 0)) || !std::isfinite(x(i, 1)) || !std::isfinite(x(i, 2)))
        throw UserError(
            fmt::format("{} must be finite numbers, but row {}, counted from 0, is ({}, {}, {}).",
                        what, i, short_text(x(i, 0)), short_text(x(i, 1)), short_text(x(i, 2))));
      points.emplace_back(x(i, 0), x(i, 1), x(i, 2));
    }
    return points;
  }

  std::vector<double>
  numbers_of(const py::handle &object, const std::string &what, const py::ssize_t n)
  {
    const auto any = py::array::ensure(object);
    refuse_mask(object, what);
    if (!any || !has_real_numbers(any)
        || (any.ndim() != 0 && (any.ndim() != 1 || any.shape(0) != n)))
    {
      PyErr_Clear();
      throw UserError(fmt::format("{} must be a number or an array of shape ({},), but is {}.",
                                  what, n, description(object)));
    }
    const auto values = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(any);
    for (py::ssize_t i = 0; i < values.size(); ++i)
      if (!std::isfinite(values.data()[i]))
        throw UserError(fmt::format("{} must be finite, but number {}, counted from 0, is {}.",
                                    what, i, short_text(values.data()[i])));
    return { values.data(), values.data() + values.size() };
  }

  std::vector<unsigned int>
  nodes_of(const py::handle &object, const std::string &what, const std::size_t n)
  {
    const auto any = py::array::ensure(object);
    refuse_mask(object, what);
    if (any && any.dtype().kind() == 'b')
      throw UserError(what + " is a mask. Take the indices: numpy.flatnonzero(mask).");
    if (!any || any.ndim() != 1 || any.shape(0) == 0
        || (any.dtype().kind() != 'i' && any.dtype().kind() != 'u'))
    {
      PyErr_Clear();
      throw UserError(
          fmt::format("{} must be an array of at least one index of a node, from 0, but "
                      "is {}{}.",
                      what, description(object),
                      any && any.ndim() == 1 && any.shape(0) > 0 ? " of no integers" : ""));
    }
    std::vector<unsigned int> nodes = indices_of(any, what);
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    if (nodes.back() >= n)
      throw UserError(
          fmt::format("{} has {}, but there are {} nodes, counted from 0.", what, nodes.back(), n));
    return nodes;
  }

  namespace
  {
    /// The triangles of a shell, with these regions.
    MshFile
    shell_of(const py::tuple &parts, const std::vector<unsigned int> &material_ids)
    {
      MshFile msh;
      msh.nodes = points_of(parts[0], "mesh: nodes");
      for (std::size_t node = 0; node < msh.nodes.size(); ++node)
        msh.node_numbers.push_back(node + 1);
      const auto rows  = rows_of<long long>(parts[1], "mesh: triangles", -1, 3);
      const auto nodes = rows.unchecked<2>();
      const auto m     = static_cast<std::size_t>(nodes.shape(0));
      if (!material_ids.empty() && material_ids.size() != m)
        throw UserError(fmt::format(
            "The mesh has {} triangles, but {} material ids. Give one for each triangle, or none.",
            m, material_ids.size()));
      for (std::size_t t = 0; t < m; ++t)
      {
        const int  tag = material_ids.empty() ? 0 : static_cast<int>(material_ids[t]);
        MshElement triangle{ t, MshElementType::triangle, tag, tag, {} };
        for (py::ssize_t v = 0; v < 3; ++v)
        {
          triangle.nodes.push_back(
              index_of(nodes(static_cast<py::ssize_t>(t), v), "mesh: triangles"));
          if (triangle.nodes.back() >= msh.nodes.size())
            throw UserError(fmt::format(
                "mesh: triangles[{}] has node {}, but there are {} nodes, counted from 0.", t,
                triangle.nodes.back(), msh.nodes.size()));
        }
        msh.elements.push_back(std::move(triangle));
      }
      return msh;
    }
  } // namespace

  MshFile
  mesh_of(const py::object &mesh, const MeshKind kind)
  {
    const py::tuple parts = parts_of(mesh);
    if (kind == MeshKind::shell)
      return shell_of(parts,
                      parts.size() == 3 ? material_ids_of(parts[2]) : std::vector<unsigned int>());
    refuse_exchanged_parts(parts);
    const Cells               cells = cells_of(parts[1]);
    std::vector<unsigned int> material_ids;
    if (parts.size() == 3)
      material_ids = material_ids_of(parts[2]);
    MshFile msh = make_msh(points_of(parts[0], "mesh: nodes"), cells, material_ids);
    for (MshElement &element : msh.elements)
      --element.number; // number of its cell
    refuse_repeated_nodes(cells);
    refuse_unused_nodes(cells, msh.nodes.size());
    refuse_repeated_cells(cells);
    return msh;
  }
} // namespace Exemplar::Python
