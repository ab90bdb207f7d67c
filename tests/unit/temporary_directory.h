// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef exemplar_tests_temporary_directory_h
#define exemplar_tests_temporary_directory_h

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>

namespace Exemplar::Testing
{
  /// A test with a directory of its own, removed at the end.
  class InTemporaryDirectory : public testing::Test
  {
  protected:
    InTemporaryDirectory()
        : directory(std::filesystem::temp_directory_path()
                    / ("exemplar_test_" + std::to_string(::getpid())))
    {
      std::filesystem::create_directories(directory);
    }

    ~InTemporaryDirectory() override
    {
      std::filesystem::remove_all(directory);
    }

    std::filesystem::path
    write_file(const std::string &name, const std::string &bytes) const
    {
      // anew, for some file systems wait for the disk when a file is cut and written again
      std::filesystem::remove(directory / name);
      std::ofstream(directory / name, std::ios::binary) << bytes;
      return directory / name;
    }

    const std::filesystem::path directory;
  };
} // namespace Exemplar::Testing

#endif
