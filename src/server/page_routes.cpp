// SPDX-License-Identifier: MIT
#include "server/page_routes.h"

#include <stdexcept>

#include <zlib.h>

#include "server/embedded_files.h"

namespace dynslam {
namespace {

std::string type_of(std::string_view name) {
  const auto is = [name](std::string_view ending) { return name.ends_with(ending); };
  if (is(".html")) return "text/html; charset=utf-8";
  if (is(".js")) return "text/javascript; charset=utf-8";
  if (is(".css")) return "text/css; charset=utf-8";
  if (is(".svg")) return "image/svg+xml";
  if (is(".png")) return "image/png";
  if (is(".webmanifest")) return "application/manifest+json";
  return "application/octet-stream";
}

/// For a client that does not say it can do so itself.
std::string unpacked(std::string_view gzipped) {
  constexpr int kGzip = 16 + MAX_WBITS;
  z_stream stream{};
  if (inflateInit2(&stream, kGzip) != Z_OK) throw std::bad_alloc();
  // zlib does not write to its input; it only says so in newer releases.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(gzipped.data()));
  stream.avail_in = static_cast<uInt>(gzipped.size());
  std::string bytes;
  int status = Z_OK;
  while (status == Z_OK) {
    char part[16384];
    stream.next_out = reinterpret_cast<Bytef*>(part);
    stream.avail_out = sizeof part;
    status = inflate(&stream, Z_NO_FLUSH);
    bytes.append(part, sizeof part - stream.avail_out);
  }
  inflateEnd(&stream);
  if (status != Z_STREAM_END) throw std::logic_error("a file of the page is not whole");
  return bytes;
}

HttpAnswer answer_with(const EmbeddedFile& file, const HttpRequest& request) {
  HttpAnswer answer;
  answer.type = type_of(file.name);
  answer.headers.emplace_back("Vary", "Accept-Encoding");
  if (request.header("accept-encoding").find("gzip") == std::string::npos) {
    answer.body = unpacked(file.bytes);
  } else {
    answer.headers.emplace_back("Content-Encoding", "gzip");
    answer.body = file.bytes;
  }
  return answer;
}

}  // namespace

void add_page(RouteTable& routes, Gate& gate) {
  if (embedded_page().empty()) {
    routes.add("GET", "/", [](const HttpRequest&, const std::string&) {
      return error_answer(404, "this program was built without its page");
    });
  }
  for (const EmbeddedFile& file : embedded_page()) {
    const auto handler = [&gate, &file](const HttpRequest& request, const std::string&) {
      const Gate::Decision decision = gate.admit(request, Role::kNone);
      return decision.refusal ? *decision.refusal : answer_with(file, request);
    };
    routes.add("GET", std::string("/").append(file.name), handler);
    if (file.name == "index.html") routes.add("GET", "/", handler);
  }
}

}  // namespace dynslam
