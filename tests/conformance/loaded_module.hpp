#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "places.hpp"
#include "rmac/sdk/module.hpp"

namespace rmac::conformance {

/// A built module, opened as it is, without the configuration system's checks: suites test what is inside. `folder` is
/// relative to the build's device tree.
class LoadedModule {
 public:
  LoadedModule(const std::string& folder, const std::string& name)
      : path_(std::string(RMAC_BINARY_DIR "/drivers/") + folder + "/" + name + ".so"),
        library_(dlopen(path_.c_str(), RTLD_NOW | RTLD_LOCAL)) {
    if (library_ == nullptr) return;
    using Entry = const sdk::ModuleDescriptor* (*)();
    if (const auto entry = reinterpret_cast<Entry>(dlsym(library_, sdk::kModuleSymbol))) descriptor_ = entry();
  }
  ~LoadedModule() {
    if (library_ != nullptr) dlclose(library_);
  }
  LoadedModule(const LoadedModule&) = delete;
  LoadedModule& operator=(const LoadedModule&) = delete;

  [[nodiscard]] const sdk::ModuleDescriptor* descriptor() const { return descriptor_; }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] const std::string& error() const { return error_; }

  /// The module's object, or null with the reason in `error()`. It must die before this module.
  template <typename Port>
  [[nodiscard]] std::shared_ptr<Port> create(sdk::Parameters parameters = {}) {
    if (descriptor_ == nullptr) {
      error_ = path_ + " does not load: build the target of the same name";
      return nullptr;
    }
    std::array<char, 256> text{};
    void* object = descriptor_->create(parameters, text.data(), text.size());
    error_ = text.data();
    return std::shared_ptr<Port>(static_cast<Port*>(object), [destroy = descriptor_->destroy](Port* port) {
      if (port != nullptr) destroy(port);
    });
  }

 private:
  std::string path_;
  void* library_;
  const sdk::ModuleDescriptor* descriptor_ = nullptr;
  std::string error_;
};

}  // namespace rmac::conformance
