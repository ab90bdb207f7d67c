// SPDX-License-Identifier: GPL-3.0-or-later
#include <exemplar/base/build_identity.h>

#include <fmt/core.h>

#include <dlfcn.h>
#include <elf.h>
#include <link.h>
#include <sys/stat.h>

#include <cstdint>
#include <cstring>

namespace Exemplar
{
  namespace
  {
    struct Search
    {
      std::uintptr_t address;
      std::string    found;
    };

    bool
    holds(const dl_phdr_info &object, const std::uintptr_t address)
    {
      for (unsigned int i = 0; i < object.dlpi_phnum; ++i)
      {
        const auto          &part  = object.dlpi_phdr[i];
        const std::uintptr_t begin = object.dlpi_addr + part.p_vaddr;
        if (part.p_type == PT_LOAD && address >= begin && address - begin < part.p_memsz)
          return true;
      }
      return false;
    }

    std::string
    hexadecimal(const char *bytes, const std::size_t n)
    {
      std::string text;
      for (std::size_t i = 0; i < n; ++i)
      {
        const auto byte = static_cast<unsigned char>(bytes[i]);
        text += "0123456789abcdef"[byte / 16];
        text += "0123456789abcdef"[byte % 16];
      }
      return text;
    }

    /// The build id among an object's notes: each is a header, a name and a description, both
    /// filled up to 4 bytes.
    std::string
    build_id_in(const char *notes, const std::size_t size)
    {
      const auto filled = [](const std::size_t n) { return (n + 3) / 4 * 4; };
      for (std::size_t at = 0; at + sizeof(ElfW(Nhdr)) <= size;)
      {
        ElfW(Nhdr) header;
        std::memcpy(&header, notes + at, sizeof(header));
        const std::size_t name = at + sizeof(header);
        const std::size_t text = name + filled(header.n_namesz);
        if (text + header.n_descsz > size)
          return "";
        if (header.n_type == NT_GNU_BUILD_ID && header.n_namesz == 4
            && std::memcmp(notes + name, "GNU", 4) == 0)
          return hexadecimal(notes + text, header.n_descsz);
        at = text + filled(header.n_descsz);
      }
      return "";
    }

    int
    look_at(dl_phdr_info *object, std::size_t, void *data)
    {
      auto &search = *static_cast<Search *>(data);
      if (!holds(*object, search.address))
        return 0;
      for (unsigned int i = 0; i < object->dlpi_phnum && search.found.empty(); ++i)
        if (const auto &part = object->dlpi_phdr[i]; part.p_type == PT_NOTE)
          search.found = build_id_in(
              reinterpret_cast<const char *>(object->dlpi_addr + part.p_vaddr), part.p_memsz);
      return 1;
    }

    std::string
    file_identity(const void *address)
    {
      Dl_info     object;
      struct stat status;
      if (dladdr(address, &object) == 0 || stat(object.dli_fname, &status) != 0)
        return "unknown";
      return fmt::format("{} {} {} {}", object.dli_fname, status.st_size, status.st_mtim.tv_sec,
                         status.st_mtim.tv_nsec);
    }
  } // namespace

  std::string
  build_identity(const void *address)
  {
    Search search{ reinterpret_cast<std::uintptr_t>(address), "" };
    dl_iterate_phdr(look_at, &search);
    return search.found.empty() ? file_identity(address) : search.found;
  }

  std::string
  own_build_identity()
  {
    static const char here = 0;
    return build_identity(&here);
  }
} // namespace Exemplar
