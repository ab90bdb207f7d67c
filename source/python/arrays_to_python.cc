// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/python/arrays_to_python.h>

namespace Exemplar::Python
{
  namespace py = pybind11;

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
    sparse.attr("has_canonical_format") = true; // scipy would search for duplicates otherwise
    return sparse;
  }
} // namespace Exemplar::Python
