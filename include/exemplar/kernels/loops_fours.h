// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_fours_h
#define exemplar_loops_fours_h

// Four numbers at once; see loops_io.h.

namespace Exemplar::Loops
{
  /// Four numbers of one node or cell; the compiler maps them to the registers that there are.
  using Four = double __attribute__((vector_size(32)));

  /// The same among other doubles. (By memcpy, GCC 12 copies halves and leaves loops rolled.)
  using FourInMemory = double __attribute__((vector_size(32), aligned(8), may_alias));

  // Internal linkage, and references: how Four is passed by value depends on the instruction set.

  [[gnu::always_inline]] static inline void
  load_four(const double *from, Four &four)
  {
    four = *reinterpret_cast<const FourInMemory *>(from);
  }

  [[gnu::always_inline]] static inline void
  add_four(const Four &four, double *to)
  {
    *reinterpret_cast<FourInMemory *>(to) += four;
  }

  /// Rows become columns.
  [[gnu::always_inline]] static inline void
  transpose(Four (&rows)[4])
  {
    const Four low_01  = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6);
    const Four high_01 = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7);
    const Four low_23  = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6);
    const Four high_23 = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);

    rows[0] = __builtin_shufflevector(low_01, low_23, 0, 1, 4, 5);
    rows[1] = __builtin_shufflevector(high_01, high_23, 0, 1, 4, 5);
    rows[2] = __builtin_shufflevector(low_01, low_23, 2, 3, 6, 7);
    rows[3] = __builtin_shufflevector(high_01, high_23, 2, 3, 6, 7);
  }
} // namespace Exemplar::Loops

#endif
