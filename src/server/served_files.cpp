#include "server/served_files.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

namespace rhexis::server {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kRecordings = "/recordings/";

constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kTypes{{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".webmanifest", "application/manifest+json"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".ico", "image/x-icon"},
    {".woff2", "font/woff2"},
    {".wasm", "application/wasm"},
    {".txt", "text/plain; charset=utf-8"},
    {".h5", "application/x-hdf5"},
}};

std::string type_of(const fs::path& path) {
  const std::string ending = path.extension().string();
  const auto known = std::find_if(kTypes.begin(), kTypes.end(), [&](const auto& type) { return type.first == ending; });
  return std::string(known == kTypes.end() ? "application/octet-stream" : known->second);
}

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

/// %41 -> A. Nothing: an escape that is none.
std::optional<std::string> unescape(std::string_view text) {
  std::string out;
  for (std::size_t k = 0; k < text.size(); ++k) {
    if (text[k] != '%') {
      out += text[k];
      continue;
    }
    if (k + 2 >= text.size()) return std::nullopt;
    const int high = hex_digit(text[k + 1]);
    const int low = hex_digit(text[k + 2]);
    if (high < 0 || low < 0) return std::nullopt;
    out += static_cast<char>(16 * high + low);
    k += 2;
  }
  return out;
}

/// A name that means a file or folder right here: not hidden, no way up, nothing that some system reads otherwise.
bool is_plain_name(std::string_view name) {
  return !name.empty() && !name.starts_with('.') && std::none_of(name.begin(), name.end(), [](unsigned char c) {
    return c < 0x20 || c == 0x7f || c == '/' || c == '\\' || c == ':' || c == '"';
  });
}

std::optional<ServedFile> describe(const fs::path& path) {
  std::error_code gone;
  if (!fs::is_regular_file(path, gone)) return std::nullopt;
  ServedFile file;
  file.path = path;
  file.type = type_of(path);
  file.bytes = fs::file_size(path, gone);
  const auto written = fs::last_write_time(path, gone).time_since_epoch().count();
  if (gone) return std::nullopt;
  file.tag = fmt::format("\"{:x}-{:x}\"", file.bytes, written);
  return file;
}

}  // namespace

Expected<ServedFiles> ServedFiles::open(const fs::path& page, const fs::path& recordings) {
  std::error_code not_there;
  ServedFiles files;
  files.page_ = fs::canonical(page, not_there);
  if (not_there || !fs::is_regular_file(files.page_ / "index.html", not_there))
    return fail("the page is not there", "`make viewer` builds it; --page names another folder", page.string());
  files.recordings_ = recordings;
  return files;
}

void ServedFiles::add_recording(const std::string& name) {
  if (is_plain_name(name)) recorded_.insert(name);
}

std::optional<ServedFile> ServedFiles::find(std::string_view target) const {
  const std::optional<std::string> path = unescape(target.substr(0, target.find_first_of("?#")));
  if (!path || !path->starts_with('/')) return std::nullopt;
  if (path->starts_with(kRecordings)) {
    const std::string name = path->substr(kRecordings.size());
    if (!recorded_.contains(name)) return std::nullopt;
    std::optional<ServedFile> file = describe(recordings_ / name);
    if (file) file->download = true;
    return file;
  }
  fs::path file = page_;
  std::string_view rest = std::string_view(*path).substr(1);
  if (rest.empty()) rest = "index.html";
  while (true) {
    const std::size_t slash = rest.find('/');
    if (!is_plain_name(rest.substr(0, slash))) return std::nullopt;
    file /= rest.substr(0, slash);
    if (slash == std::string_view::npos) break;
    rest.remove_prefix(slash + 1);
  }
  // A link may lead out of the folder.
  std::error_code not_there;
  const fs::path real = fs::canonical(file, not_there);
  if (not_there || std::mismatch(page_.begin(), page_.end(), real.begin(), real.end()).first != page_.end())
    return std::nullopt;
  return describe(real);
}

}  // namespace rhexis::server
