#include "gateway/modules/module_loader.hpp"

#include <dlfcn.h>
#include <elf.h>
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <system_error>

#include "gateway/modules/trusted_place.hpp"

namespace rmac::gateway {
namespace {

constexpr std::uintmax_t kMostBytes = 64 << 20;  // what is larger is no module, and would keep the gateway from ending

namespace fs = std::filesystem;

struct CloseLibrary {
  void operator()(void* library) const noexcept { dlclose(library); }
};
using Library = std::unique_ptr<void, CloseLibrary>;

/// A folder of our own that is gone, with what is in it, when this goes out of scope.
class PrivateFolder {
 public:
  PrivateFolder() = default;
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;
  ~PrivateFolder() {
    if (std::error_code ignored; !path_.empty()) fs::remove_all(path_, ignored);
  }
  [[nodiscard]] bool make() {
    std::error_code error;
    const fs::path temporary = fs::temp_directory_path(error);
    if (error) return false;
    std::string pattern = (temporary / "rmac-module-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr) return false;
    path_ = pattern;
    return true;
  }
  [[nodiscard]] const fs::path& path() const noexcept { return path_; }

 private:
  fs::path path_;
};

/// False for an ELF file that ends before its tables do: half copied, it would be mapped beyond its end and kill the
/// daemon. What is no ELF file at all is left to the loader, which says so.
bool is_whole(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Elf64_Ehdr header{};
  if (!stream.read(reinterpret_cast<char*>(&header), sizeof(header))) return true;
  if (!std::equal(header.e_ident, header.e_ident + SELFMAG, ELFMAG) || header.e_ident[EI_CLASS] != ELFCLASS64)
    return true;
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  const auto ends_inside = [&](std::uintmax_t offset, std::uintmax_t length) {
    return offset <= size && length <= size - offset;
  };
  if (error || !ends_inside(header.e_shoff, std::uintmax_t{header.e_shentsize} * header.e_shnum)) return false;
  if (header.e_phentsize != sizeof(Elf64_Phdr) || !stream.seekg(static_cast<std::streamoff>(header.e_phoff)))
    return false;
  for (int i = 0; i < header.e_phnum; ++i) {
    Elf64_Phdr segment{};
    if (!stream.read(reinterpret_cast<char*>(&segment), sizeof(segment))) return false;
    if (segment.p_type == PT_LOAD && !ends_inside(segment.p_offset, segment.p_filesz)) return false;
  }
  return true;
}

const char* last_loader_error() {
  const char* text = dlerror();
  return text != nullptr ? text : "no reason given";
}

/// The loader takes a library at a known path for the one it has already, even when the file was replaced; hence each
/// opening gets a path that was never used before. The mapping outlives the copy.
Expected<Library> open_private_copy(const fs::path& file) {
  PrivateFolder folder;
  if (!folder.make()) {
    return failure(MinorCode::Other, fmt::format("cannot make a private folder for a copy of {}: is the temporary "
                                                 "folder (TMPDIR) writable?",
                                                 file.string()));
  }
  if (!is_whole(file)) {
    return failure(MinorCode::Other, fmt::format("module {} is not a whole shared object of this processor; copy or "
                                                 "build it again",
                                                 file.string()));
  }
  const fs::path copy = folder.path() / file.filename();
  std::error_code error;
  fs::copy_file(file, copy, error);
  if (error) {
    return failure(MinorCode::Other, fmt::format("cannot copy module {}: {}", file.string(), error.message()));
  }
  Library library(dlopen(copy.c_str(), RTLD_NOW | RTLD_LOCAL));
  if (!library) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("cannot load module {}: {}", file.string(), last_loader_error()));
  }
  return library;
}

/// The parameters of a choice in the form that crosses the module's border; points into the choice.
std::vector<sdk::Parameter> to_parameters(const sdk::ModuleChoice& choice) {
  std::vector<sdk::Parameter> parameters;
  for (const auto& [name, numbers] : choice.numbers) parameters.push_back({name.c_str(), numbers, nullptr});
  for (const auto& [name, text] : choice.texts) parameters.push_back({name.c_str(), {}, text.c_str()});
  return parameters;
}

Expected<> check(const sdk::ModuleDescriptor* descriptor, const fs::path& file, const std::string& name,
                 sdk::ModuleKind kind) {
  const auto refuse = [&](const std::string& what) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("module {}: {}", file.string(), what));
  };
  if (descriptor == nullptr) return refuse(fmt::format("{}() returned no descriptor", sdk::kModuleSymbol));
  // Nothing behind the version may be read before the version fits: another one may lay it out differently.
  if (descriptor->abi != sdk::kModuleAbi) {
    return refuse(
        fmt::format("it was built for module ABI {} and this controller has ABI {}; rebuild it against this "
                    "controller's SDK",
                    descriptor->abi, sdk::kModuleAbi));
  }
  if (descriptor->name == nullptr || descriptor->build_id == nullptr || descriptor->create == nullptr ||
      descriptor->destroy == nullptr) {
    return refuse("its descriptor is incomplete; define it with RMAC_MODULE");
  }
  if (descriptor->kind != kind) {
    return refuse(fmt::format("it is of kind {}, but {} is wanted here", to_string(descriptor->kind), to_string(kind)));
  }
  if (name != descriptor->name) {
    return refuse(fmt::format("it calls itself \"{}\"; file and descriptor must have the same name", descriptor->name));
  }
  return {};
}

}  // namespace

const char* to_string(sdk::ModuleKind kind) noexcept {
  switch (kind) {
    case sdk::ModuleKind::Kinematics:
      return "kinematics";
    case sdk::ModuleKind::ActuatorMap:
      return "actuator map";
    case sdk::ModuleKind::ServoLaw:
      return "servo control law";
    case sdk::ModuleKind::DigitalControlInterface:
      return "digital control interface";
    case sdk::ModuleKind::DigitalIoInterface:
      return "digital I/O interface";
    case sdk::ModuleKind::DeviceDriver:
      return "device driver";
  }
  return "unknown kind";
}

ModuleLoader::ModuleLoader(std::vector<fs::path> folders, Opens opens) : folders_(std::move(folders)), opens_(opens) {}

Expected<fs::path> ModuleLoader::find_file(const std::string& subfolder, const std::string& name,
                                           const std::string& extension, const std::string& what) const {
  const auto is_name_character = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  if (name.empty() || !std::all_of(name.begin(), name.end(), is_name_character)) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("\"{}\" cannot be the name of a {}: letters, digits, _ and - only", name, what));
  }
  std::string searched;
  for (const fs::path& parent : folders_) {
    const fs::path folder = subfolder.empty() ? parent : parent / subfolder;
    const fs::path file = folder / (name + extension);
    if (std::error_code problem; fs::is_regular_file(file, problem)) {
      if (const auto bytes = fs::file_size(file, problem); !problem && bytes > kMostBytes) {
        return failure(MinorCode::InvalidParameterValue, fmt::format("{} {}: {} has {} bytes; at most {} are read",
                                                                     what, name, file.string(), bytes, kMostBytes));
      }
      return file;
    }
    searched += (searched.empty() ? "" : ", ") + folder.string();
  }
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("there is no {} {}: no file {}{} in {}", what, name, name, extension,
                             searched.empty() ? "any folder (none is configured)" : searched));
}

Expected<fs::path> ModuleLoader::find_module(const std::string& name, sdk::ModuleKind kind) const {
  return find_file("", name, ".so", fmt::format("{} module", to_string(kind)));
}

Expected<OpenModule> ModuleLoader::open(const std::string& name, sdk::ModuleKind kind) const {
  const auto file = find_module(name, kind);
  if (!file) return tl::unexpected(file.error());
  if (opens_ == Opens::Trusted) {
    if (auto trusted = check_trusted(*file, folders_); !trusted) return tl::unexpected(trusted.error());
  }
  auto opened = open_private_copy(*file);
  if (!opened) return tl::unexpected(opened.error());

  using Entry = const sdk::ModuleDescriptor* (*)() noexcept;
  const auto entry = reinterpret_cast<Entry>(dlsym(opened->get(), sdk::kModuleSymbol));
  if (entry == nullptr) {
    return failure(
        MinorCode::InvalidParameterValue,
        fmt::format("{} is no module of this controller: it does not export {}(); define it with RMAC_MODULE",
                    file->string(), sdk::kModuleSymbol));
  }
  const sdk::ModuleDescriptor* descriptor = entry();
  if (auto fits = check(descriptor, *file, name, kind); !fits) return tl::unexpected(fits.error());
  return OpenModule{*file, std::move(*opened), descriptor};
}

Expected<ModuleObject<void>> OpenModule::create(const sdk::ModuleChoice& choice) const {
  std::array<char, 512> why{};
  const auto parameters = to_parameters(choice);
  void* object = descriptor->create(parameters, why.data(), why.size());
  why.back() = '\0';
  if (object == nullptr) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("module {} refuses its parameters: {}", choice.name,
                               why.front() != '\0' ? why.data() : "it gives no reason"));
  }
  // The deleter owns the library: the object's code must be there until the object is not.
  std::shared_ptr<void> owner(object,
                              [destroy = descriptor->destroy, kept = library](void* made) noexcept { destroy(made); });
  return ModuleObject<void>{std::move(owner), descriptor->build_id};
}

}  // namespace rmac::gateway
