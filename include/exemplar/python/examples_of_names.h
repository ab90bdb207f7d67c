// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_python_examples_of_names_h
#define exemplar_python_examples_of_names_h

#include <utility>
#include <vector>

namespace Exemplar::Python
{
  /// Pairs of a public name, such as "Problem.step", and its example as Python's doctest runs it.
  /// There `problem` is a dynamic scene with an example pose and the handles left and right, after
  /// two steps, `static` one that was solved, and `np` is numpy.
  const std::vector<std::pair<const char *, const char *>> &
  examples_of_names();
} // namespace Exemplar::Python

#endif
