#include "operator/web/page_files.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace heel {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxFiles = 256;
constexpr std::uintmax_t kMaxFileBytes = 4 << 20;

struct MediaType {
  std::string_view extension, type;
};
constexpr std::array kMediaTypes{MediaType{".html", "text/html; charset=utf-8"},
                                 MediaType{".js", "text/javascript; charset=utf-8"},
                                 MediaType{".mjs", "text/javascript; charset=utf-8"},
                                 MediaType{".css", "text/css; charset=utf-8"},
                                 MediaType{".svg", "image/svg+xml"},
                                 MediaType{".png", "image/png"},
                                 MediaType{".ico", "image/x-icon"},
                                 MediaType{".json", "application/json"},
                                 MediaType{".webmanifest", "application/manifest+json"}};

/// Empty: a kind of file that no page has.
std::string_view media_type_of(const fs::path& file) {
  const std::string extension = file.extension().string();
  for (const MediaType& known : kMediaTypes)
    if (known.extension == extension) return known.type;
  return "";
}

}  // namespace

PageFiles PageFiles::load() {
  const char* const folder = std::getenv("HEEL_PAGE_DIR");
  return {folder != nullptr ? folder : HEEL_INSTALLED_PAGE, HEEL_DYGRAPHS};
}

PageFiles::PageFiles(const std::string& folder, const std::string& charts) {
  add_folder(folder);
  if (files_.empty()) spdlog::warn("the page's files are not in {}: browsers get no page", folder);
  add("/lib/dygraphs.min.js", charts + "/dygraph.min.js");
  add("/lib/dygraph.min.css", charts + "/dygraph.min.css");
}

void PageFiles::add_folder(const std::string& folder) {
  std::error_code error;
  for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder, error)) {
    if (!entry.is_regular_file(error) || files_.size() >= kMaxFiles) continue;
    add("/" + fs::path(entry.path()).lexically_relative(folder).generic_string(), entry.path().string());
  }
  const auto start = files_.find("/index.html");
  if (start != files_.end()) files_["/"] = start->second;
}

void PageFiles::add(const std::string& path, const std::string& file) {
  const std::string_view type = media_type_of(file);
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  if (type.empty() || error || bytes > kMaxFileBytes) return;
  std::ifstream in(file, std::ios::binary);
  files_[path] = {type, {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()}};
}

const PageFile* PageFiles::find(std::string_view path) const {
  const auto found = files_.find(path);
  return found == files_.end() ? nullptr : &found->second;
}

}  // namespace heel
