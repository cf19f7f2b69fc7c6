// The page's files and the recordings, as a browser asks for them; and who gets none.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/server/live_socket.h"
#include "tests/server/served.h"

namespace rhexis {
namespace {

namespace fs = std::filesystem;
using test::ask;
using test::body_of;
using test::status_of;
using testing::HasSubstr;
using testing::Not;

TEST(Page, FilesComeWithTypeTagAndPolicy) {
  const test::Served served("page");
  const std::string index = ask(served.port, "GET", "/");
  EXPECT_EQ(status_of(index), 200);
  EXPECT_EQ(body_of(index), "<title>Rhexis</title>");
  for (const char* header :
       {"Content-Type: text/html; charset=utf-8", "X-Content-Type-Options: nosniff",
        "Content-Security-Policy: ", "Cache-Control: no-cache", "Referrer-Policy: no-referrer", "Content-Length: 21"})
    EXPECT_THAT(index, HasSubstr(header));
  EXPECT_THAT(index, Not(HasSubstr("Set-Cookie")));
  EXPECT_EQ(body_of(ask(served.port, "GET", "/index.html?x=1")), "<title>Rhexis</title>");
  const std::string script = ask(served.port, "GET", "/assets/app.js");
  EXPECT_THAT(script, HasSubstr("Content-Type: text/javascript"));
  EXPECT_EQ(body_of(script), "export {};");

  const std::size_t at = script.find("ETag: ") + 6;
  const std::string tag = script.substr(at, script.find("\r\n", at) - at);
  const std::string unchanged = ask(served.port, "GET", "/assets/app.js", "If-None-Match: " + tag + "\r\n");
  EXPECT_EQ(status_of(unchanged), 304);
  EXPECT_EQ(body_of(unchanged), "");
  std::ofstream(served.folder / "page/assets/app.js") << "export const x = 1;";
  EXPECT_EQ(status_of(ask(served.port, "GET", "/assets/app.js", "If-None-Match: " + tag + "\r\n")), 200);
}

TEST(Page, HeadTellsTheLengthAndSendsNothing) {
  const test::Served served("head");
  const std::string head = ask(served.port, "HEAD", "/assets/app.js");
  EXPECT_EQ(status_of(head), 200);
  EXPECT_THAT(head, HasSubstr("Content-Length: 10"));
  EXPECT_EQ(body_of(head), "");
  const std::string none = ask(served.port, "HEAD", "/none");
  EXPECT_EQ(status_of(none), 404);
  EXPECT_EQ(body_of(none), "");
}

TEST(Page, RequestsFollowEachOtherOnOneConnection) {
  const test::Served served("kept");
  test::Socket socket(served.port);
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(socket.send("GET /assets/app.js HTTP/1.1\r\nHost: localhost\r\n\r\n"));
    EXPECT_EQ(status_of(socket.receive_until("\r\n\r\n")), 200);
    EXPECT_TRUE(socket.receive(10).has_value());
  }
}

TEST(Page, NothingOutsideOfTheFolderIsReached) {
  const test::Served served("traversal");
  fs::create_symlink(served.folder / "secret.txt", served.folder / "page/link.txt");
  fs::create_directory_symlink(served.folder, served.folder / "page/up");
  fs::create_directory(served.folder / "page-twin");
  std::ofstream(served.folder / "page-twin/secret.txt") << "secret";
  fs::create_directory_symlink(served.folder / "page-twin", served.folder / "page/twin");
  for (const std::string& target : std::vector<std::string>{"/../secret.txt",
                                                            "/assets/../../secret.txt",
                                                            "/%2e%2e/secret.txt",
                                                            "/..%2fsecret.txt",
                                                            "/%2e%2e%2fsecret.txt",
                                                            "/..%5csecret.txt",
                                                            "/..\\secret.txt",
                                                            "//secret.txt",
                                                            "/./../secret.txt",
                                                            "/assets//../../secret.txt",
                                                            "/.hidden",
                                                            "/%2ehidden",
                                                            "/link.txt",
                                                            "/up/secret.txt",
                                                            "/twin/secret.txt",
                                                            "/assets",
                                                            "/assets/",
                                                            "/index.html%00.js",
                                                            "/index.html/",
                                                            "/%",
                                                            "/%4",
                                                            "/%zz",
                                                            "/recordings/",
                                                            "/recordings/../secret.txt",
                                                            "/recordings/%2e%2e%2fsecret.txt",
                                                            "/recordings/run.h5",
                                                            "http://127.0.0.1/../secret.txt",
                                                            "*",
                                                            "secret.txt",
                                                            "/none",
                                                            "/" + std::string(2000, 'a'),
                                                            "/" + std::string(300, '/')}) {
    const std::string answer = ask(served.port, "GET", target);
    EXPECT_TRUE(status_of(answer) == 404 || status_of(answer) == 400) << target << "\n" << answer;
    EXPECT_THAT(answer, Not(HasSubstr("secret\n"))) << target;
    EXPECT_NE(body_of(answer), "secret") << target;
  }
}

TEST(Page, ARecordingIsFetchedOnceItIsMadeKnown) {
  test::Served served("recordings");
  EXPECT_EQ(status_of(ask(served.port, "GET", "/recordings/run.h5")), 404);
  test::LiveSocket client(served.port);
  ASSERT_EQ(client.shake_hands(), 101);
  ASSERT_NE(client.hear(wire::Payload::Hello), nullptr);  // it is in the lobby: what is taken now reaches it
  for (const char* name : {"run.h5", "../secret.txt", "none.h5"}) {
    wire::RecordedT recorded;
    recorded.file = name;
    served.server->take(wire::encode(std::move(recorded)));
    ASSERT_NE(client.hear(wire::Payload::Recorded), nullptr);
  }
  const std::string answer = ask(served.port, "GET", "/recordings/run.h5");
  EXPECT_EQ(body_of(answer), "recording");
  EXPECT_THAT(answer, HasSubstr("Content-Disposition: attachment; filename=\"run.h5\""));
  EXPECT_EQ(status_of(ask(served.port, "GET", "/recordings/none.h5")), 404);
  EXPECT_EQ(status_of(ask(served.port, "GET", "/recordings/../secret.txt")), 404);
  EXPECT_EQ(status_of(ask(served.port, "GET", "/recordings/..%2fsecret.txt")), 404);
}

TEST(Page, OnlyGetAndHeadWithoutABody) {
  const test::Served served("methods");
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH", "TRACE"}) {
    const std::string answer = ask(served.port, method, "/");
    EXPECT_EQ(status_of(answer), 405) << method;
    EXPECT_THAT(answer, HasSubstr("Allow: GET, HEAD"));
  }
  EXPECT_EQ(status_of(ask(served.port, "POST", "/", "Content-Length: 5\r\n")), 400);
  EXPECT_EQ(status_of(ask(served.port, "GET", "/", "Transfer-Encoding: chunked\r\n")), 400);
  EXPECT_EQ(status_of(ask(served.port, "GET", "/live")), 426);
  EXPECT_EQ(status_of(ask(served.port, "GET", "/", "X: " + std::string(20000, 'x') + "\r\n")), 431);
}

TEST(Page, ForeignNamesAndPagesAreRefused) {
  const test::Served served("foreign");
  EXPECT_EQ(status_of(ask(served.port, "GET", "/", "", "rebound.evil.org")), 403);
  EXPECT_EQ(status_of(ask(served.port, "GET", "/", "Host: evil.org\r\n")), 403) << "two hosts";
  EXPECT_EQ(status_of(ask(served.port, "GET", "/", "Origin: http://evil.org\r\n")), 403);
  const std::string ours = "127.0.0.1:" + std::to_string(served.port);
  EXPECT_EQ(status_of(ask(served.port, "GET", "/", "Origin: http://" + ours + "\r\n")), 200);
  const auto shake = [&](const std::string& headers, const std::string& host = {}) {
    return test::LiveSocket(served.port).shake_hands(headers, "/live", host);
  };
  EXPECT_EQ(shake(""), 101);
  EXPECT_EQ(shake("Origin: http://" + ours + "\r\n"), 101);
  EXPECT_EQ(shake("Origin: http://evil.org\r\n"), 403);
  EXPECT_EQ(shake("Origin: http://localhost:3000\r\n"), 403);
  EXPECT_EQ(shake("Origin: null\r\n"), 403);
  EXPECT_EQ(shake("", "rebound.evil.org"), 403);
  EXPECT_EQ(test::LiveSocket(served.port).shake_hands("", "/other"), 404);
}

TEST(Page, WithoutTheTokenNobodyGetsIn) {
  const test::Served served("token", [](server::ServerSettings& settings) { settings.token = "0123456789abcdef"; });
  EXPECT_THAT(served.server->url(), HasSubstr("/?token=0123456789abcdef"));
  for (const char* target : {"/", "/assets/app.js", "/none", "/?token=0123456789abcdee", "/recordings/run.h5"})
    EXPECT_EQ(status_of(ask(served.port, "GET", target)), 403) << target;
  const std::string index = ask(served.port, "GET", "/?token=0123456789abcdef");
  EXPECT_EQ(status_of(index), 200);
  const std::size_t at = index.find("Set-Cookie: ") + 12;
  const std::string cookie = index.substr(at, index.find(';', at) - at);
  EXPECT_EQ(status_of(ask(served.port, "GET", "/assets/app.js", "Cookie: " + cookie + "\r\n")), 200);
  EXPECT_EQ(test::LiveSocket(served.port).shake_hands(), 403);
  EXPECT_EQ(test::LiveSocket(served.port).shake_hands("", "/live?token=0123456789abcdee"), 403);
  EXPECT_EQ(test::LiveSocket(served.port).shake_hands("", "/live?token=0123456789abcdef"), 101);
}

TEST(Page, ListeningFailsInWords) {
  test::Served served("listening");
  server::ServerSettings settings;
  settings.port = served.port;
  settings.page = served.folder / "page";
  const auto wrong = [&](const server::ServerSettings& tried) {
    const auto made = server::Server::listen(tried, served.target);
    EXPECT_FALSE(made.has_value());
    return made ? std::string() : made.error().message();
  };
  EXPECT_THAT(wrong(settings), HasSubstr("is taken"));
  settings.port = 0;
  settings.address = "0.0.0.0";
  EXPECT_THAT(wrong(settings), HasSubstr("no token is asked"));
  settings.address = "here";
  EXPECT_THAT(wrong(settings), HasSubstr("'here' is not an address"));
  settings.address = "127.0.0.1";
  settings.page = served.folder / "out";
  EXPECT_THAT(wrong(settings), HasSubstr("make viewer"));
}

}  // namespace
}  // namespace rhexis
