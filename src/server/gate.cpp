#include "server/gate.h"

#include <unistd.h>
#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>

#include <fmt/format.h>
#include <boost/asio/ip/address.hpp>

#include "base/check.h"

namespace rhexis::server {
namespace {

bool is_same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// The value of `name` in "a=1SEPARATORb=2"; empty when it is not there.
std::string_view value_in(std::string_view list, std::string_view name, char separator) {
  while (!list.empty()) {
    const std::size_t end = std::min(list.find(separator), list.size());
    std::string_view part = list.substr(0, end);
    list.remove_prefix(std::min(end + 1, list.size()));
    while (part.starts_with(' ')) part.remove_prefix(1);
    if (part.size() > name.size() && part.starts_with(name) && part[name.size()] == '=')
      return part.substr(name.size() + 1);
  }
  return {};
}

std::string_view token_in_query(std::string_view target) {
  const std::size_t query = target.find('?');
  return query == std::string_view::npos ? std::string_view() : value_in(target.substr(query + 1), "token", '&');
}

/// Cookies belong to a name, not to its port: two servers of one machine must not take each other's.
std::string cookie_name(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  const std::string_view port = colon == std::string_view::npos ? "80" : host.substr(colon + 1);
  const bool digits = std::all_of(port.begin(), port.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  return fmt::format("rhexis-{}", digits ? port : "80");
}

}  // namespace

bool names_loopback(std::string_view host) {
  const std::size_t bracket = host.find(']');
  const std::size_t colon = host.find(':', bracket == std::string_view::npos ? 0 : bracket);
  const std::string_view port = colon == std::string_view::npos ? std::string_view() : host.substr(colon + 1);
  if (!std::all_of(port.begin(), port.end(), [](unsigned char c) { return std::isdigit(c) != 0; })) return false;
  std::string_view name = host.substr(0, colon);
  if (name.starts_with('[') && name.ends_with(']')) name = name.substr(1, name.size() - 2);
  if (is_same_name(name, "localhost")) return true;
  boost::system::error_code not_an_address;
  const auto address = boost::asio::ip::make_address(std::string(name), not_an_address);
  return !not_an_address && address.is_loopback();
}

bool is_same_token(std::string_view a, std::string_view b) {
  // Of the length alone time may tell: it is no secret.
  if (a.size() != b.size()) return false;
  unsigned differ = 0;
  for (std::size_t k = 0; k < a.size(); ++k)
    differ |= static_cast<unsigned char>(a[k]) ^ static_cast<unsigned char>(b[k]);
  return differ == 0;
}

std::string make_token() {
  std::array<std::uint8_t, 16> bytes{};
  RHEXIS_CHECK(::getentropy(bytes.data(), bytes.size()) == 0, "the kernel gives no randomness");
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

Verdict Gate::judge(const Visit& visit) const {
  if (visit.host.empty() || (loopback_ && !names_loopback(visit.host))) return Verdict::foreign_host;
  // https where something before us speaks TLS.
  if (visit.origin && !is_same_name(*visit.origin, fmt::format("http://{}", visit.host)) &&
      !is_same_name(*visit.origin, fmt::format("https://{}", visit.host)))
    return Verdict::foreign_origin;
  if (token_.empty() || is_same_token(token_in_query(visit.target), token_) ||
      is_same_token(value_in(visit.cookies, cookie_name(visit.host), ';'), token_))
    return Verdict::let_in;
  return Verdict::no_token;
}

std::string Gate::cookie(const Visit& visit) const {
  if (token_.empty() || !is_same_token(token_in_query(visit.target), token_)) return {};
  return fmt::format("{}={}; HttpOnly; SameSite=Strict; Path=/", cookie_name(visit.host), token_);
}

}  // namespace rhexis::server
