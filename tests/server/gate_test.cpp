#include "server/gate.h"

#include <gtest/gtest.h>

namespace rhexis::server {
namespace {

constexpr const char* kToken = "0123456789abcdef";

Verdict judge(const Gate& gate, std::string_view host, std::optional<std::string_view> origin = {},
              std::string_view target = "/", std::string_view cookies = {}) {
  return gate.judge({.host = host, .origin = origin, .target = target, .cookies = cookies});
}

TEST(Gate, NamesOfThisMachineAreItsAddressesAndLocalhost) {
  for (const char* name :
       {"127.0.0.1", "127.0.0.1:8080", "127.1.2.3:1", "localhost", "LocalHost:8080", "[::1]", "[::1]:8080"})
    EXPECT_TRUE(names_loopback(name)) << name;
  for (const char* name :
       {"", "evil.org", "evil.org:8080", "localhost.evil.org", "127.0.0.1.evil.org", "10.0.0.1", "localhost.",
        "localhost:80:80", "localhost:8x", "[::2]:80", "127.0.0.1@evil.org", "[127.0.0.1", "0.0.0.0", "2130706433"})
    EXPECT_FALSE(names_loopback(name)) << name;
}

TEST(Gate, OnThisMachineAForeignNameOrPageIsRefused) {
  const Gate gate(true, "");
  EXPECT_EQ(judge(gate, "127.0.0.1:8080"), Verdict::let_in);
  EXPECT_EQ(judge(gate, "localhost:9000", "http://localhost:9000"), Verdict::let_in) << "through a tunnel";
  EXPECT_EQ(judge(gate, ""), Verdict::foreign_host);
  EXPECT_EQ(judge(gate, "rebound.evil.org:8080", "http://rebound.evil.org:8080"), Verdict::foreign_host);
  for (const char* origin : {"http://evil.org", "http://localhost:3000", "http://127.0.0.1:8080", "null", "",
                             "http://localhost:80800", "localhost:8080", "file://"})
    EXPECT_EQ(judge(gate, "localhost:8080", origin), Verdict::foreign_origin) << origin;
}

TEST(Gate, WithATokenNobodyComesInWithoutIt) {
  for (const bool loopback : {true, false}) {
    const Gate gate(loopback, kToken);
    const std::string_view host = "127.0.0.1:8080";
    EXPECT_EQ(judge(gate, host, {}, "/live?token=0123456789abcdef"), Verdict::let_in);
    EXPECT_EQ(judge(gate, host, {}, "/?a=b&token=0123456789abcdef&c=d"), Verdict::let_in);
    EXPECT_EQ(judge(gate, host, {}, "/x.js", "a=b; rhexis-8080=0123456789abcdef"), Verdict::let_in);
    for (const char* target : {"/", "/?token", "/?token=", "/?token=0123456789abcde", "/?token=0123456789abcdeg",
                               "/?token=0123456789abcdef0", "/?xtoken=0123456789abcdef", "/#token=0123456789abcdef",
                               "/token=0123456789abcdef"})
      EXPECT_EQ(judge(gate, host, {}, target), Verdict::no_token) << target;
    EXPECT_EQ(judge(gate, host, {}, "/", "rhexis-9090=0123456789abcdef"), Verdict::no_token) << "of another server";
    EXPECT_EQ(judge(gate, host, "http://evil.org", "/?token=0123456789abcdef"), Verdict::foreign_origin);
  }
}

TEST(Gate, TheCookieIsGivenForTheTokenAndOpensTheGate) {
  const Gate gate(false, kToken);
  EXPECT_EQ(gate.cookie({.host = "lab:8080", .origin = {}, .target = "/", .cookies = {}}), "");
  const std::string cookie =
      gate.cookie({.host = "lab:8080", .origin = {}, .target = "/?token=0123456789abcdef", .cookies = {}});
  EXPECT_EQ(cookie, "rhexis-8080=0123456789abcdef; HttpOnly; SameSite=Strict; Path=/");
  EXPECT_EQ(judge(gate, "lab:8080", {}, "/x.js", cookie.substr(0, cookie.find(';'))), Verdict::let_in);
  EXPECT_EQ(Gate(true, "").cookie({.host = "lab", .origin = {}, .target = "/?token=", .cookies = {}}), "");
}

TEST(Gate, TokensAreLongAndNeverTheSame) {
  const std::string token = make_token();
  EXPECT_EQ(token.size(), 32U);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, make_token());
  EXPECT_TRUE(is_same_token(token, token));
  EXPECT_FALSE(is_same_token(token, token.substr(1)));
}

}  // namespace
}  // namespace rhexis::server
