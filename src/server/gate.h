#pragma once

/// Who is let in. A page of somebody else, open in the same browser, can make it talk to this machine: by a name that
/// it has the name server resolve to 127.0.0.1 (Host tells), or outright (Origin tells).

#include <optional>
#include <string>
#include <string_view>

namespace rhexis::server {

/// What is asked, as far as it matters here.
struct Visit {
  std::string_view host;                   ///< header; empty: none
  std::optional<std::string_view> origin;  ///< header, which only browsers send
  std::string_view target;                 ///< "/path?query"
  std::string_view cookies;                ///< header
};

enum class Verdict { let_in, foreign_host, foreign_origin, no_token };

class Gate {
 public:
  /// `loopback`: only names of this machine are right. `token`: asked of every visit; empty: of none.
  Gate(bool loopback, std::string token) : loopback_(loopback), token_(std::move(token)) {}

  [[nodiscard]] Verdict judge(const Visit& visit) const;
  /// The page's further files are asked for without a query: a visit that has the token in its query gets this cookie,
  /// which does as well. Empty: no token is asked.
  [[nodiscard]] std::string cookie(const Visit& visit) const;

 private:
  bool loopback_;
  std::string token_;
};

/// 128 bits of the kernel's randomness, in hexadecimal.
[[nodiscard]] std::string make_token();

/// Takes as long whatever differs, so that time tells nothing of how much of it was right.
[[nodiscard]] bool is_same_token(std::string_view a, std::string_view b);

/// What `host` (of a Host header: with port, IPv6 in brackets) names is this machine, whoever resolves it.
[[nodiscard]] bool names_loopback(std::string_view host);

}  // namespace rhexis::server
