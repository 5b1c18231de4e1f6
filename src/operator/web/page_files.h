// The files of the page, read once into memory: what a browser can get is what stands in this table, and no
// request waits for the disk.
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace heel {

struct PageFile {
  std::string_view media_type;
  std::string bytes;
};

class PageFiles {
 public:
  /// From HEEL_PAGE_DIR, or else from where the package puts them. What is missing is logged, and absent.
  static PageFiles load();
  /// `folder`: the page; `charts`: the folder of dygraphs.
  PageFiles(const std::string& folder, const std::string& charts);

  /// Null: there is no such file. The path is "/", "/app.js" or the like.
  const PageFile* find(std::string_view path) const;
  bool empty() const { return files_.empty(); }

 private:
  void add_folder(const std::string& folder);
  void add(const std::string& path, const std::string& file);

  std::map<std::string, PageFile, std::less<>> files_;
};

}  // namespace heel
