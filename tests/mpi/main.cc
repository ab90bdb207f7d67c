// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <mpi.h>

// Run by mpirun.
int
main(int argc, char *argv[])
{
  testing::InitGoogleTest(&argc, argv);
  MPI_Init(&argc, &argv);
  const int failures = RUN_ALL_TESTS();
  MPI_Finalize();
  return failures;
}
