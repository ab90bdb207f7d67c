// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/algebra/cholmod_analysis.h>
#include <exemplar/algebra/minimum_degree.h>

namespace Exemplar
{
  double
  operations_by_minimum_degree(const SymmetricPattern &pattern)
  {
    CholmodCommon         common;
    cholmod_common *const state = &common;
    state->supernodal           = CHOLMOD_SIMPLICIAL; // counts alone
    state->nmethods             = 1;
    state->method[0].ordering   = CHOLMOD_AMD;
    cholmod_sparse  matrix      = cholmod_view(pattern, nullptr);
    cholmod_factor *factor      = cholmod_analyze(&matrix, state);
    cholmod_free_factor(&factor, state);
    common.check("analysis");
    return state->fl;
  }
} // namespace Exemplar
