// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_run_problem_h
#define exemplar_run_problem_h

// Header for other programs (doc/embedding.md): the scene, its inputs, and the problem.

#include <exemplar/run/problem/problem.h>

#endif
