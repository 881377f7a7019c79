// SPDX-License-Identifier: MIT
#include "server/access_gate.h"

namespace dynslam {
namespace {

AccessRequest access_request(const HttpRequest& request) {
  const auto header = [&request](const std::string& name) {
    const auto found = request.headers.find(name);
    return found == request.headers.end() ? std::nullopt : std::optional(found->second);
  };
  return {request.address,        request.method,   !request.header("upgrade").empty(),
          header("host"),         header("origin"), header("cookie"),
          header("authorization")};
}

HttpAnswer refusal_of(const Judgement& judgement) {
  HttpAnswer answer = error_answer(judgement.status, judgement.why);
  if (judgement.status == 401) answer.headers.emplace_back("WWW-Authenticate", "Bearer");
  return answer;
}

}  // namespace

Gate::Decision AccessGate::admit(const HttpRequest& request, Role needed) {
  const Judgement judged = access_.judge(access_request(request), needed, AccessTime::now());
  if (!judged.is_in()) return {refusal_of(judged), {}};
  const auto still_allowed = [this, id = judged.id, needed] {
    return access_.why_ended(id, needed, AccessTime::now());
  };
  return {std::nullopt, {judged.name, judged.role, judged.id, still_allowed}};
}

Gate::Decision AccessGate::admit_to_stop(const HttpRequest& request) {
  const Judgement judged = access_.judge_stop(access_request(request), AccessTime::now());
  if (!judged.is_in()) return {refusal_of(judged), {}};
  return {std::nullopt, {judged.name, judged.role, judged.id, {}}};
}

}  // namespace dynslam
