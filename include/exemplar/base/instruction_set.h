// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_instruction_set_h
#define exemplar_instruction_set_h

// No deal.II header here: see matrix3.h.

namespace Exemplar
{
  /// Instruction sets for which kernels are compiled, each including the ones before.
  enum class InstructionSet
  {
    baseline, ///< instructions of every CPU of the architecture
    avx2,     ///< x86-64-v3
    avx512    ///< x86-64-v4
  };

  /// The best instruction set of this CPU.
  inline InstructionSet
  best_instruction_set()
  {
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq")
        && __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512bw")
        && __builtin_cpu_supports("avx512vl"))
      return InstructionSet::avx512;
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")
        && __builtin_cpu_supports("bmi2"))
      return InstructionSet::avx2;
#endif
    return InstructionSet::baseline;
  }
} // namespace Exemplar

#endif
