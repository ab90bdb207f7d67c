// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/mpi_session.h>

#include <gtest/gtest.h>

int
main(int argc, char *argv[])
{
  testing::InitGoogleTest(&argc, argv);
  const Exemplar::MpiSession mpi; // for the tests of multigrid
  return RUN_ALL_TESTS();
}
