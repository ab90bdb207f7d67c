// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_hot_loop_h
#define exemplar_hot_loop_h

// Loops over the cells are "flattened", because the kernels are too large for the
// compiler to inline them by its own judgement and a call costs as much as some of them
// do; and compiled for three levels of instruction sets, of which the loader takes the
// best that the CPU has.
#ifdef __x86_64__
#define EXEMPLAR_HOT_LOOP                                                                          \
  [[gnu::flatten, gnu::target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")]]
#else
#define EXEMPLAR_HOT_LOOP [[gnu::flatten]]
#endif

#endif
