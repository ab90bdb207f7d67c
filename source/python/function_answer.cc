// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/errors.h>
#include <exemplar/base/number_text.h>
#include <exemplar/python/arrays_from_python.h>
#include <exemplar/python/from_python.h>
#include <exemplar/python/function_answer.h>

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace Exemplar::Python
{
  namespace py = pybind11;

  namespace
  {
    using Indices = py::array_t<long long, py::array::c_style | py::array::forcecast>;
    using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

    /// One of the arrays that a sparse array consists of.
    py::array
    part_of(const py::object &sparse, const char *name, const std::string &what)
    {
      const auto array = py::array::ensure(py::getattr(sparse, name, py::none()));
      if (!array || array.ndim() != 1)
        throw UserError(fmt::format("{}: its array {} is damaged. Make it anew by "
                                    "scipy.sparse.coo_array((data, (rows, columns))).",
                                    what, name));
      return array;
    }

    Indices
    indices_in(const py::object &sparse, const char *name, const std::string &what)
    {
      const py::array array = part_of(sparse, name, what);
      if (const char kind = array.dtype().kind(); kind != 'i' && kind != 'u')
        throw UserError(fmt::format("{}: its array {} must have integers, but is {} of {}.", what,
                                    name, description(array),
                                    std::string(py::str(array.dtype().attr("name")))));
      return array;
    }

    Numbers
    values_in(const py::object &sparse, const std::string &what)
    {
      const py::array array = part_of(sparse, "data", what);
      require_real(array, what + ": its array data");
      return array;
    }

    /// Rows, columns and values of the entries of a sparse array.
    struct Triplets
    {
      std::vector<long long> rows, columns;
      std::vector<double>    values;
    };

    /// The row of each entry, from scipy's indptr, which is checked: scipy itself reads beyond its
    /// arrays if it is wrong.
    std::vector<long long>
    rows_of(const Indices     &starts,
            const std::size_t  n,
            const std::size_t  n_entries,
            const std::string &what)
    {
      const auto refuse = [&](const std::string &how)
      {
        throw UserError(what + ": its array indptr " + how
                        + ". Allowed: from 0 to the number of entries, ascending, one number more "
                          "than it has rows.");
      };
      if (static_cast<std::size_t>(starts.size()) != n + 1)
        refuse(fmt::format("has {} numbers, but there are {} rows", starts.size(), n));
      const long long *const start = starts.data();
      if (start[0] != 0)
        refuse(fmt::format("begins with {}", start[0]));
      for (std::size_t i = 0; i < n; ++i)
        if (start[i + 1] < start[i])
          refuse(fmt::format("falls from {} to {} at row {}", start[i], start[i + 1], i));
      if (start[n] > static_cast<long long>(n_entries))
        refuse(fmt::format("ends at {}, but there are {} entries", start[n], n_entries));
      std::vector<long long> rows;
      for (std::size_t i = 0; i < n; ++i)
        rows.insert(rows.end(), start[i + 1] - start[i], static_cast<long long>(i));
      return rows;
    }

    Triplets
    triplets(const std::vector<long long> &rows, const Indices &columns, const Numbers &values)
    {
      return { rows,
               { columns.data(), columns.data() + rows.size() },
               { values.data(), values.data() + rows.size() } };
    }

    /// Entries of a csr_array, or those of the transpose of a csc_array: the matrix is symmetric.
    Triplets
    of_compressed(const py::object &sparse, const std::size_t n, const std::string &what)
    {
      const Numbers values    = values_in(sparse, what);
      const Indices columns   = indices_in(sparse, "indices", what);
      const auto    n_entries = static_cast<std::size_t>(std::min(values.size(), columns.size()));
      return triplets(rows_of(indices_in(sparse, "indptr", what), n, n_entries, what), columns,
                      values);
    }

    Triplets
    of_coordinates(const py::object &sparse, const std::string &what)
    {
      const Numbers values  = values_in(sparse, what);
      const Indices rows    = indices_in(sparse, "row", what),
                    columns = indices_in(sparse, "col", what);
      if (rows.size() != values.size() || columns.size() != values.size())
        throw UserError(fmt::format("{}: it has {} rows and {} columns of {} entries. Give each "
                                    "entry one of both.",
                                    what, rows.size(), columns.size(), values.size()));
      return triplets({ rows.data(), rows.data() + rows.size() }, columns, values);
    }

    /// Refuses a lil_array whose lists of columns and of values differ in length, which scipy would
    /// not notice.
    void
    require_equal_lists(const py::object &sparse, const std::size_t n, const std::string &what)
    {
      const py::list rows(sparse.attr("rows")), data(sparse.attr("data"));
      if (rows.size() != n || data.size() != n)
        throw UserError(fmt::format("{}: it has {} lists of columns and {} of entries, but {} "
                                    "rows. Make it anew.",
                                    what, rows.size(), data.size(), n));
      for (std::size_t i = 0; i < n; ++i)
        if (py::len(rows[i]) != py::len(data[i]))
          throw UserError(
              fmt::format("{}: row {} has {} columns of {} entries. Give each entry one.", what, i,
                          py::len(rows[i]), py::len(data[i])));
    }

    Triplets
    of_other(const py::object  &sparse,
             const std::string &format,
             const std::size_t  n,
             const std::string &what)
    {
      try
      {
        if (format == "lil")
          require_equal_lists(sparse, n, what);
        return of_coordinates(sparse.attr("tocoo")(), what);
      }
      catch (py::error_already_set &error)
      {
        if (!error.matches(PyExc_Exception)) // Ctrl-C
          throw;
        throw UserError(what + " is no sparse array that scipy can read ("
                        + std::string(py::str(error.value())) + "). Make it anew.");
      }
    }

    Triplets
    triplets_of(const py::object &sparse, const std::size_t n, const std::string &what)
    {
      const std::string format = py::str(py::getattr(sparse, "format", py::none()));
      if (format == "csr" || format == "csc")
        return of_compressed(sparse, n, what);
      return format == "coo" ? of_coordinates(sparse, what) : of_other(sparse, format, n, what);
    }

    void
    require_shape(const py::object &hessian, const std::size_t n, const std::string &what)
    {
      if (!py::hasattr(hessian, "tocoo"))
        throw UserError(fmt::format("{} must be a sparse array of scipy of shape ({}, {}), or "
                                    "None, but is {}. Of a dense one take "
                                    "scipy.sparse.csr_array(H).",
                                    what, n, n, description(hessian)));
      const py::object shape = hessian.attr("shape");
      if (!shape.equal(py::make_tuple(n, n)))
        throw UserError(fmt::format("{} has the shape {}, but must have ({}, {}): three rows a "
                                    "node.",
                                    what, std::string(py::str(shape)), n, n));
    }

    /// Throws UserError unless H x = H^T x for some x.
    void
    require_symmetry(const std::vector<MatrixEntry> &entries,
                     const std::size_t               n,
                     const std::string              &what)
    {
      std::vector<double> x(n), Hx(n, 0.), HTx(n, 0.), scale(n, 0.);
      for (std::size_t i = 0; i < n; ++i)
        x[i] = 1.5 + std::sin(static_cast<double>(i)); // a generic direction
      for (const MatrixEntry &entry : entries)
      {
        Hx[entry.row] += entry.value * x[entry.column];
        HTx[entry.column] += entry.value * x[entry.row];
        scale[entry.row] += std::abs(entry.value * x[entry.column]);
      }
      const double size = n == 0 ? 0. : *std::max_element(scale.begin(), scale.end());
      for (std::size_t i = 0; i < n; ++i)
        if (!(std::abs(Hx[i] - HTx[i]) <= 1e-8 * size))
          throw UserError(fmt::format("{} is not symmetric, or not finite, in row {} (of node {}). "
                                      "Return all of it, both triangles.",
                                      what, i, i / 3));
    }

    std::vector<MatrixEntry>
    entries_of(const Triplets &given, const std::size_t n, const std::string &what)
    {
      std::vector<MatrixEntry> entries;
      for (std::size_t i = 0; i < given.values.size(); ++i)
      {
        for (const long long index : { given.rows[i], given.columns[i] })
          if (index < 0 || index >= static_cast<long long>(n))
            throw UserError(
                fmt::format("{} has an entry in row or column {}, but they go from 0 to "
                            "{}.",
                            what, index, n - 1));
        entries.push_back({ static_cast<unsigned int>(given.rows[i]),
                            static_cast<unsigned int>(given.columns[i]), given.values[i] });
      }
      return entries;
    }

    const char *const usage
        = "add_term calls function(positions, time), which returns energy, gradient, hessian.";

    double
    energy_of(const py::object &object, const std::string &what)
    {
      try
      {
        if (const double energy = real_number_of(object, what); std::isfinite(energy))
          return energy;
      }
      catch (const py::type_error &) // reported below
      {
      }
      throw UserError(what + ": the energy must be a finite number [J], but is "
                      + std::string(py::repr(object)) + ".");
    }

    /// The lower triangle of a Hessian (n, n), a sparse array of scipy; None has no entries. `what`
    /// stands for it in messages. Throws UserError for anything else: other shapes, entries that
    /// are no finite real numbers, indices that lead out of the arrays or of the matrix, what is
    /// not symmetric.
    std::vector<MatrixEntry>
    lower_entries_of(const py::object &hessian, const std::size_t n, const std::string &what)
    {
      if (hessian.is_none())
        return {};
      require_shape(hessian, n, what);
      const std::vector<MatrixEntry> all = entries_of(triplets_of(hessian, n, what), n, what);
      require_symmetry(all, n, what);
      std::vector<MatrixEntry> lower;
      std::copy_if(all.begin(), all.end(), std::back_inserter(lower),
                   [](const MatrixEntry &entry) { return entry.row >= entry.column; });
      return lower;
    }
  } // namespace

  FunctionAnswer
  answer_of(const py::object  &function,
            const std::string &term_name,
            const Vector      &positions,
            const double       time)
  {
    const py::gil_scoped_acquire lock;
    const auto                   n = static_cast<py::ssize_t>(positions.size() / 3);
    const std::string            what
        = term_name + ": what the function returns at t = " + shortest_text(time);
    const py::array_t<double> points({ n, py::ssize_t(3) }, positions.begin());
    const py::object          parts = call(function, py::make_tuple(points, time), usage);
    if (!py::isinstance<py::tuple>(parts) || py::len(parts) != 3)
      throw UserError(what + " must be energy, gradient, hessian, but is " + description(parts)
                      + ".");
    const py::tuple three(parts);
    FunctionAnswer  answer{
      positions, time, energy_of(three[0], what), Vector(positions.size()), {}
    };
    const auto gradient = points_of(three[1], what + ": the gradient", n);
    for (unsigned int dof = 0; dof < positions.size(); ++dof)
      answer.gradient[dof] = gradient[dof / 3][dof % 3];
    answer.hessian = lower_entries_of(three[2], positions.size(), what + ": the Hessian");
    return answer;
  }
} // namespace Exemplar::Python
