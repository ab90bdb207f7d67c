// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_function_answer_h
#define exemplar_function_answer_h

#include <exemplar/run/problem/problem.h>

#include <pybind11/pybind11.h>

#include <algorithm>
#include <string>
#include <vector>

namespace Exemplar::Python
{
  /// An entry of a symmetric matrix, in its lower triangle: row >= column.
  struct MatrixEntry
  {
    unsigned int row, column;
    double       value;
  };

  /// The values that a term's function has returned, with the place and time that it was given.
  struct FunctionAnswer
  {
    Vector                   positions;
    double                   time   = 0.;
    double                   energy = 0.;
    Vector                   gradient;
    std::vector<MatrixEntry> hessian; ///< may have several entries in one place

    bool
    is_for(const Vector &other_positions, const double other_time) const
    {
      return time == other_time && positions.size() == other_positions.size()
             && std::equal(positions.begin(), positions.end(), other_positions.begin());
    }
  };

  /// Calls function(positions (n,3), time) -> energy, gradient (n,3), sparse Hessian (3n,3n) or
  /// None; `term_name` stands for it in messages. Throws UserError if it returns anything else, and
  /// what the function raises. Takes Python's lock.
  FunctionAnswer
  answer_of(const pybind11::object &function,
            const std::string      &term_name,
            const Vector           &positions,
            double                  time);
} // namespace Exemplar::Python

#endif
