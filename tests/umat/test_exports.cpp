// The shared libraries as files: what they export, what they need, under which names they are found.
#include <dlfcn.h>
#include <elf.h>
#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

namespace {

using Names = std::set<std::string>;

// The dynamic section and symbol table of a 64-bit ELF file.
class SharedObject {
  public:
    explicit SharedObject(const std::string& path) {
        std::ifstream file(path, std::ios::binary);
        bytes_.assign(std::istreambuf_iterator<char>(file), {});
        const auto header = at<Elf64_Ehdr>(0);
        for (int i = 0; i < header.e_shnum; ++i) {
            const auto section = at<Elf64_Shdr>(header.e_shoff + static_cast<std::size_t>(i) * header.e_shentsize);
            const auto strings = [&] {
                return at<Elf64_Shdr>(header.e_shoff + std::size_t{section.sh_link} * header.e_shentsize).sh_offset;
            };
            if (section.sh_type == SHT_DYNSYM) read_symbols(section, strings());
            if (section.sh_type == SHT_DYNAMIC) read_dynamic(section, strings());
        }
    }
    Names exported, needed, weak_references;

  private:
    template <class T>
    T at(std::size_t offset) const {
        T value{};
        if (offset + sizeof value <= bytes_.size()) std::memcpy(&value, bytes_.data() + offset, sizeof value);
        return value;
    }
    std::string text(std::size_t offset) const { return offset < bytes_.size() ? &bytes_[offset] : ""; }
    void read_symbols(const Elf64_Shdr& section, std::size_t strings) {
        for (std::size_t i = 1; i < section.sh_size / sizeof(Elf64_Sym); ++i) {
            const auto symbol = at<Elf64_Sym>(section.sh_offset + i * sizeof(Elf64_Sym));
            const std::string name = text(strings + symbol.st_name);
            if (symbol.st_shndx != SHN_UNDEF) exported.insert(name);
            else if (ELF64_ST_BIND(symbol.st_info) == STB_WEAK) weak_references.insert(name);
        }
    }
    void read_dynamic(const Elf64_Shdr& section, std::size_t strings) {
        for (std::size_t i = 0; i < section.sh_size / sizeof(Elf64_Dyn); ++i) {
            const auto entry = at<Elf64_Dyn>(section.sh_offset + i * sizeof(Elf64_Dyn));
            if (entry.d_tag == DT_NEEDED) needed.insert(text(strings + entry.d_un.d_val));
        }
    }
    std::vector<char> bytes_;
};

// The names between "global:" and "local:" of a version script.
Names promised(const std::string& map) {
    std::ifstream file(LODE_EXPORT_MAPS "/" + map);
    Names names;
    bool is_global = false;
    for (std::string word; file >> word;) {
        if (word == "global:") is_global = true;
        else if (word == "local:") is_global = false;
        else if (is_global) names.insert(word.substr(0, word.find(';')));
    }
    return names;
}

struct Library {
    const char *path, *map;
};
constexpr Library libraries[] = {{LODE_LIBRARY, "exports.map"}, {LODE_SINGLE_PRECISION_LIBRARY, "exports-sp.map"}};

TEST(SharedLibrary, ExportsWhatTheMapPromisesAndNoMore) {
    for (const Library& library : libraries) {
        const Names names = promised(library.map), exported = SharedObject(library.path).exported;
        EXPECT_GE(names.size(), 7u);
        for (const std::string& name : names) EXPECT_TRUE(exported.count(name)) << name << " in " << library.path;
        // Sanitizers and coverage add symbols of their own, so only the plain build can be held to no more than these.
        if (!LODE_INSTRUMENTED) {
            EXPECT_EQ(exported, names) << library.path;
        }
    }
}

TEST(SharedLibrary, NeedsOnlyTheCLibrary) {
    const auto is_c_library = [](const std::string& name) {
        return name == "libc.so.6" || name == "libm.so.6" || name.starts_with("ld-linux");
    };
    // An instrumented library is not the one that is shipped: it needs the run-time of its sanitizer, and that of C++.
    const auto is_run_time = [](const std::string& name) {
        for (const char* known : {"libasan.so.", "libubsan.so.", "libtsan.so.", "libstdc++.so.", "libgcc_s.so."})
            if (name.starts_with(known)) return true;
        return false;
    };
    for (const Library& library : libraries)
        for (const std::string& name : SharedObject(library.path).needed)
            EXPECT_TRUE(is_c_library(name) || (LODE_INSTRUMENTED && is_run_time(name))) << library.path << ": " << name;
}

// A strong reference to a routine of Abaqus would keep the library from loading anywhere else.
TEST(SharedLibrary, HostRoutinesAreWeakReferences) {
    for (const Library& library : libraries) {
        const Names weak = SharedObject(library.path).weak_references;
        for (const char* name : {"xit_", "xplb_exit_", "stdb_abqerr_", "xplb_abqerr_"}) EXPECT_EQ(weak.count(name), 1u);
    }
}

TEST(SharedLibrary, HasTheNamesThatHostsLookFor) {
    namespace fs = std::filesystem;
    const fs::path folder = fs::path(LODE_LIBRARY).parent_path();
    for (const char* name : {"libstandardU.so", "libexplicitU-D.so"})
        EXPECT_EQ(fs::canonical(folder / name), fs::canonical(LODE_LIBRARY)) << name;
    EXPECT_EQ(fs::canonical(folder / "libexplicitU.so"), fs::canonical(LODE_SINGLE_PRECISION_LIBRARY));
}

TEST(SharedLibrary, UpperCaseNamesAreTheSameRoutines) {
    for (const Library& library : libraries) {
        void* handle = dlopen(library.path, RTLD_NOW | RTLD_LOCAL);
        ASSERT_NE(handle, nullptr) << dlerror();
        EXPECT_NE(dlsym(handle, "vumat_"), nullptr);
        EXPECT_EQ(dlsym(handle, "vumat_"), dlsym(handle, "VUMAT"));
        EXPECT_EQ(dlsym(handle, "umat_"), dlsym(handle, "UMAT"));
        dlclose(handle);
    }
}

// Both libraries list the same models.
TEST(SharedLibrary, SinglePrecisionHasTheSameModels) {
    using CountFunction = int (*)();
    int counts[2] = {};
    for (const int i : {0, 1}) {
        void* handle = dlopen(libraries[i].path, RTLD_NOW | RTLD_LOCAL);
        ASSERT_NE(handle, nullptr) << dlerror();
        counts[i] = reinterpret_cast<CountFunction>(dlsym(handle, "lode_model_count"))();
    }
    EXPECT_GT(counts[0], 0);
    EXPECT_EQ(counts[0], counts[1]);
}

}  // namespace
