// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_loops_fours_h
#define exemplar_loops_fours_h

// SIMD vectors of four numbers; see loops_io.h.

namespace Exemplar::Loops
{
  /// Four numbers of one node or cell; the compiler maps them to the registers available.
  using Four = double __attribute__((vector_size(32)));

  /// Four in an array of doubles, with their alignment.
  using FourInMemory = double __attribute__((vector_size(32), aligned(8), may_alias));

  /// Load a vector from an array with the alignment of its numbers. By memcpy, GCC 12 copies halves
  /// and leaves loops rolled; Clang 14 assumes full alignment for the vector types.
  template <typename InMemory, typename Number, typename Vector>
  [[gnu::always_inline]] static inline void
  load_vector(const Number *from, Vector &vector)
  {
#ifdef __clang__
    __builtin_memcpy(&vector, from, sizeof(vector));
#else
    vector = *reinterpret_cast<const InMemory *>(from);
#endif
  }

  /// Add a vector to numbers in an array.
  template <typename InMemory, typename Number, typename Vector>
  [[gnu::always_inline]] static inline void
  add_vector(const Vector &vector, Number *to)
  {
#ifdef __clang__
    Vector sum;
    __builtin_memcpy(&sum, to, sizeof(sum));
    sum += vector;
    __builtin_memcpy(to, &sum, sizeof(sum));
#else
    *reinterpret_cast<InMemory *>(to) += vector;
#endif
  }

  // Internal linkage, and references: how Four is passed by value depends on the instruction set.

  [[gnu::always_inline]] static inline void
  load_four(const double *from, Four &four)
  {
    load_vector<FourInMemory>(from, four);
  }

  [[gnu::always_inline]] static inline void
  add_four(const Four &four, double *to)
  {
    add_vector<FourInMemory>(four, to);
  }

  /// Transpose a 4 x 4 matrix.
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
