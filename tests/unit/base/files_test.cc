// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/atomic_file.h>
#include <exemplar/base/digest.h>
#include <exemplar/base/directory_lock.h>
#include <exemplar/base/errors.h>
#include <exemplar/base/sealed_file.h>

#include "expect_contains.h"
#include "temporary_directory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

namespace Exemplar
{
  namespace
  {
    class FilesTest : public Testing::InTemporaryDirectory
    {
    protected:
      std::filesystem::path
      write(const std::string &bytes, const std::string &name = "file") const
      {
        return write_file(name, bytes);
      }
    };

    TEST_F(FilesTest, AtomicFileKeepsOldUntilCommit)
    {
      const auto path = write("old", "file");
      {
        AtomicFile file(path);
        file.stream() << "half" << std::flush;
        EXPECT_TRUE(std::filesystem::exists(path.string() + ".tmp"));
      }
      EXPECT_FALSE(std::filesystem::exists(path.string() + ".tmp"));
      EXPECT_EQ(sha256(path), sha256_of_text("old"));

      const std::string large(200000, 'x');
      AtomicFile        file(path);
      file.stream() << "new\r\n" << large;
      file.commit();
      EXPECT_EQ(sha256(path), sha256_of_text("new\r\n" + large));
      EXPECT_FALSE(std::filesystem::exists(path.string() + ".tmp"));
    }

    TEST_F(FilesTest, AtomicFileNamesTheReason)
    {
      const auto message_of = [](const std::function<void()> &action) -> std::string
      {
        try
        {
          action();
          return "";
        }
        catch (const std::runtime_error &error)
        {
          return error.what();
        }
      };
      const auto missing = directory / "none" / "file";
      const auto message = message_of([&] { AtomicFile file(missing); });
      expect_contains(message, missing.string());
      expect_contains(message, "No such file or directory");

      // A device without space, met early (large) and at commit (small).
      for (const std::size_t size : { 10, 1000000 })
      {
        const auto path = write("old", "full");
        std::filesystem::create_symlink("/dev/full", directory / "full.tmp");
        const auto full = message_of(
            [&]
            {
              AtomicFile file(path);
              file.stream() << std::string(size, 'x');
              file.commit();
            });
        expect_contains(full, "full.tmp: No space left on device");
        EXPECT_EQ(sha256(path), sha256_of_text("old"));
      }
    }

    TEST_F(FilesTest, ADirectoryIsLockedOnce)
    {
      {
        const DirectoryLock first(directory, "refused");
        EXPECT_THROW(DirectoryLock(directory, "refused"), UserError);
        EXPECT_TRUE(first.is_in_place());
      }
      const std::filesystem::path moved = directory / "moved", place = directory / "place";
      std::filesystem::create_directory(place);
      const DirectoryLock again(directory, "refused"), inner(place, "refused");
      std::filesystem::rename(place, moved);
      EXPECT_FALSE(inner.is_in_place());
      std::filesystem::create_directory(place);
      EXPECT_FALSE(inner.is_in_place());
      const DirectoryLock of_the_new_one(place, "refused");
      EXPECT_TRUE(of_the_new_one.is_in_place());
      EXPECT_EQ(std::distance(std::filesystem::directory_iterator(place), {}), 0);
    }

    TEST_F(FilesTest, DigestsKnownTexts)
    {
      const std::string abc = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
      EXPECT_EQ(sha256_of_text("abc"), abc);
      EXPECT_EQ(sha256(write("abc")), abc);
      EXPECT_EQ(sha256_of_text(""),
                "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
      EXPECT_EQ(sha256(write(std::string(200000, 'x'))), sha256_of_text(std::string(200000, 'x')));
      EXPECT_THROW(sha256(directory / "nowhere"), UserError);
      EXPECT_THROW(sha256(directory), UserError);
      EXPECT_THROW(sha256("/dev/zero"), UserError); // which has no end
      EXPECT_EQ(sha256_of_begin(write("abcde"), 3), abc);
      EXPECT_THROW(sha256_of_begin(write("ab"), 3), UserError);
    }

    TEST_F(FilesTest, ASealIsOfTheBytesBeforeIt)
    {
      const std::string text = "bytes\0to keep";
      const auto        file = write(text);
      EXPECT_EQ(n_sealed_bytes(file), 0u);
      seal_file(file);
      EXPECT_EQ(n_sealed_bytes(file), text.size());

      std::ostringstream streamed;
      SealingBuffer      buffer(streamed);
      std::ostream(&buffer) << text.substr(0, 2) << text[2] << text.substr(3);
      buffer.seal();
      EXPECT_EQ(sha256_of_text(streamed.str()), sha256(file));

      EXPECT_EQ(n_sealed_bytes(write(streamed.str() + "\n")), 0u);
      EXPECT_EQ(n_sealed_bytes(write("B" + streamed.str().substr(1))), 0u);
      EXPECT_EQ(n_sealed_bytes(write("")), 0u);
      EXPECT_EQ(n_sealed_bytes(directory), 0u);
      EXPECT_EQ(n_sealed_bytes(directory / "nowhere"), 0u);
    }
  } // namespace
} // namespace Exemplar
