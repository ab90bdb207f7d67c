// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/build_identity.h>
#include <exemplar/base/confinement.h>
#include <exemplar/base/process_copy.h>

#include "temporary_directory.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <csignal>
#include <cstdlib>
#include <thread>

namespace Exemplar::Testing
{
  namespace
  {
    class ConfinementTest : public InTemporaryDirectory
    {
    protected:
      /// Confine a copy of this process and call what returns whether something could be done.
      bool
      can(const std::function<bool()> &act) const
      {
        return in_process_copy(
                   [&]
                   {
                     const auto walls = confine_this_process({ directory / "readable" });
                     return std::string(walls.empty() ? "no walls" : act() ? "yes" : "no");
                   },
                   { "The work", "", 60. })
               == "yes";
      }
    };

    TEST_F(ConfinementTest, WhatIsNotNeededIsGivenUp)
    {
      const std::string file  = write_file("file", "text");
      const std::string here  = directory;
      const auto        opens = [&](const std::string &path, const int flags)
      { return open(path.c_str(), flags, 0666) >= 0; };
      const pid_t parent = getpid();
      EXPECT_FALSE(can([] { return std::system("true") == 0; }));
      EXPECT_FALSE(can([] { return fork() >= 0; }));
      EXPECT_FALSE(can([] { return execl("/bin/true", "true", nullptr) == 0; }));
      for (const int flags : { O_WRONLY, O_RDWR, O_WRONLY | O_APPEND, O_RDONLY | O_TRUNC })
        EXPECT_FALSE(can([&] { return opens(file, flags); })) << flags;
      EXPECT_FALSE(can([&] { return opens(here + "/new", O_RDONLY | O_CREAT); }));
      EXPECT_FALSE(can([&] { return opens(here, O_RDWR | O_TMPFILE); }));
      EXPECT_FALSE(can([&] { return unlink(file.c_str()) == 0; }));
      EXPECT_FALSE(can([&] { return rename(file.c_str(), (here + "/new").c_str()) == 0; }));
      EXPECT_FALSE(can([&] { return mkdir((here + "/new").c_str(), 0777) == 0; }));
      EXPECT_FALSE(can([&] { return symlink(file.c_str(), (here + "/new").c_str()) == 0; }));
      EXPECT_FALSE(can([&] { return link(file.c_str(), (here + "/new").c_str()) == 0; }));
      EXPECT_FALSE(can([&] { return chmod(file.c_str(), 0777) == 0; }));
      EXPECT_FALSE(can([&] { return truncate(file.c_str(), 1) == 0; }));
      EXPECT_FALSE(can([] { return socket(AF_INET, SOCK_STREAM, 0) >= 0; }));
      EXPECT_FALSE(can([] { return memfd_create("x", 0) >= 0; }));
      EXPECT_FALSE(can([=] { return kill(parent, 0) == 0; }));
      EXPECT_EQ(std::filesystem::file_size(file), 4u);
      EXPECT_FALSE(std::filesystem::exists(directory / "new"));
    }

    TEST_F(ConfinementTest, ComputingAndReadingGoOn)
    {
      write_file("readable", "text");
      EXPECT_TRUE(can([&] { return open((directory / "readable").c_str(), O_RDONLY) >= 0; }));
      EXPECT_TRUE(can([] { return open("/etc/passwd", O_RDONLY) >= 0; }));
      EXPECT_TRUE(can(
          []
          {
            bool has_run = false;
            std::thread([&] { has_run = true; }).join();
            return has_run;
          }));
      EXPECT_TRUE(can([] { return std::vector<double>(10000000, 1.).back() == 1.; }));
    }

    TEST_F(ConfinementTest, OtherFilesCannotBeReadWhereTheKernelHasLandlock)
    {
      const std::string file         = write_file("file", "text");
      const bool        has_landlock = in_process_copy(
                                    []
                                    {
                                      const auto walls = confine_this_process({});
                                      return walls.empty() ? std::string() : walls.back();
                                    },
                                    { "The work", "", 60. })
                                == "landlock";
      EXPECT_EQ(can([&] { return open(file.c_str(), O_RDONLY) >= 0; }), !has_landlock);
    }

    TEST(BuildIdentityTest, EachFileHasItsOwn)
    {
      const std::string own = own_build_identity();
      EXPECT_GE(own.size(), 16u);
      EXPECT_EQ(own, own_build_identity());
      EXPECT_NE(own, build_identity(dlsym(RTLD_DEFAULT, "gmshInitialize")));
      EXPECT_NE(own, build_identity(dlsym(RTLD_DEFAULT, "getenv")));
    }
  } // namespace
} // namespace Exemplar::Testing
