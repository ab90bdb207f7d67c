// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_exemplar_h
#define exemplar_exemplar_h

// The door for programs of others (doc/embedding.md): they include this header and no other of
// exemplar. What it names keeps its place; all else that these headers bring along is internal, and
// may change from version to version.

#include <exemplar/base/environment.h>         // use_one_blas_thread()
#include <exemplar/base/errors.h>              // UserError, SolverFailure, Interrupted
#include <exemplar/base/mpi_session.h>         // MpiSession
#include <exemplar/potential/potential_term.h> // PotentialTerm, for terms of one's own
#include <exemplar/run/problem.h>              // SceneParameters, Inputs, Problem, Laboratory
#include <exemplar/run/scene/scene_file.h>     // SceneFile

#endif
