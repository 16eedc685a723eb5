#include "client/cli/script_parser.h"

#include <utility>

#include "client/cli/script_words.h"

namespace haptic::cli {
namespace {

struct Statement {
  int line = 0;
  std::vector<Word> words;
  std::vector<Statement> body;  // of a loop
};

// the word if it is written without quotes and variables
std::string keyword(const Word& word) {
  return word.size() == 1 && !word[0].variable && !word[0].quoted ? word[0].text : "";
}

std::string plain_name(const Statement& statement, std::size_t index, const char* what) {
  std::string name = index < statement.words.size() ? keyword(statement.words[index]) : "";
  if (!is_variable_name(name)) {
    throw ScriptError(statement.line,
                      std::string(what) + " needs the name of a variable: letters, digits, _");
  }
  return name;
}

// hands out lines, those that end in \ joined with the next
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}

  bool next(std::string& text, int& line) {
    if (rest_.empty()) {
      return false;
    }
    line = number_ + 1;
    text = physical_line();
    while (continues(text) && !rest_.empty()) {
      text.pop_back();
      text += physical_line();
    }
    for (const char c : text) {
      if (static_cast<unsigned char>(c) < ' ' && c != '\t') {
        throw ScriptError(line, "a control character");
      }
    }
    return true;
  }

 private:
  std::string physical_line() {
    const std::size_t end = rest_.find('\n');
    std::string line(rest_.substr(0, end));
    rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
    ++number_;
    if (!line.empty() && line.back() == '\r') {
      line.pop_back();
    }
    return line;
  }

  // an even number of \ are characters, and a comment ends with its line
  static bool continues(const std::string& line) noexcept {
    const std::size_t first = line.find_first_not_of(" \t");
    if (first != std::string::npos && line[first] == '#') {
      return false;
    }
    const std::size_t last_other = line.find_last_not_of('\\');
    const std::size_t backslashes = line.size() - (last_other == std::string::npos ? 0 : last_other + 1);
    return backslashes % 2 == 1;
  }

  std::string_view rest_;
  int number_ = 0;
};

void check_statement(const Statement& statement) {
  const std::string first = keyword(statement.words[0]);
  if (first == "set") {
    plain_name(statement, 1, "set");
    if (statement.words.size() < 3) {
      throw ScriptError(statement.line, "set needs a value: set name value");
    }
  } else if (first == "for") {
    plain_name(statement, 1, "for");
    if (statement.words.size() < 4 || keyword(statement.words[2]) != "in") {
      throw ScriptError(statement.line, "a loop begins: for name in value...");
    }
  } else if (first == "end" && statement.words.size() > 1) {
    throw ScriptError(statement.line, "nothing may follow end");
  }
}

// the statements up to "end", or of the whole text for the loop at line 0
std::vector<Statement> parse_block(LineReader& reader, int loop_line, int depth) {
  if (depth > kMaxNesting) {
    throw ScriptError(loop_line, "loops are nested deeper than " + std::to_string(kMaxNesting));
  }
  std::vector<Statement> block;
  std::string text;
  int line = 0;
  while (reader.next(text, line)) {
    Statement statement{line, split_words(text, line), {}};
    if (statement.words.empty()) {
      continue;
    }
    check_statement(statement);
    const std::string first = keyword(statement.words[0]);
    if (first == "end") {
      if (loop_line == 0) {
        throw ScriptError(line, "end without for");
      }
      return block;
    }
    if (first == "for") {
      statement.body = parse_block(reader, line, depth + 1);
    }
    block.push_back(std::move(statement));
  }
  if (loop_line != 0) {
    throw ScriptError(loop_line, "this for has no end");
  }
  return block;
}

class Unroller {
 public:
  explicit Unroller(const Variables& defines) : defines_(defines), variables_(defines) {}

  void run(const std::vector<Statement>& block) {
    for (const Statement& statement : block) {
      count(statement.line);
      const std::string first = keyword(statement.words[0]);
      if (first == "set") {
        assign(statement);
      } else if (first == "for") {
        loop(statement);
      } else if (std::vector<std::string> words = expand(statement, 0); !words.empty()) {
        lines_.push_back({statement.line, std::move(words)});
      }
    }
  }

  std::vector<ScriptLine> take() { return std::move(lines_); }

 private:
  void count(int line) {
    if (++statements_ > kMaxStatements) {
      throw ScriptError(line, "the script does more than " + std::to_string(kMaxStatements) + " things");
    }
  }

  void assign(const Statement& statement) {
    const std::string name = keyword(statement.words[1]);
    std::string value;
    for (const std::string& word : expand(statement, 2)) {
      value += (value.empty() ? "" : " ") + word;
    }
    if (defines_.count(name) == 0) {
      variables_[name] = std::move(value);
    }
  }

  void loop(const Statement& statement) {
    const std::string name = keyword(statement.words[1]);
    for (const std::string& value : expand(statement, 3)) {
      count(statement.line);
      variables_[name] = value;
      run(statement.body);
    }
  }

  std::vector<std::string> expand(const Statement& statement, std::size_t first) {
    std::vector<std::string> words;
    std::size_t bytes = 0;
    for (std::size_t i = first; i < statement.words.size(); ++i) {
      expand_word(statement.words[i], statement.line, bytes, words);
    }
    return words;
  }

  void expand_word(const Word& word, int line, std::size_t& bytes, std::vector<std::string>& words) {
    std::string current;
    bool begun = false;
    for (const Piece& piece : word) {
      const std::string& text = piece.variable ? value_of(piece.text, line) : piece.text;
      spend(text.size() + 1, line, bytes);
      if (!piece.variable || piece.quoted) {
        current += text;
        begun = true;
        continue;
      }
      for (const char c : text) {
        if (c != ' ' && c != '\t') {
          current += c;
          begun = true;
        } else if (begun) {
          words.push_back(std::exchange(current, {}));
          begun = false;
        }
      }
    }
    if (begun) {
      words.push_back(std::move(current));
    }
  }

  const std::string& value_of(const std::string& name, int line) const {
    const auto found = variables_.find(name);
    if (found == variables_.end()) {
      throw ScriptError(line, "$" + name + " has no value");
    }
    return found->second;
  }

  void spend(std::size_t size, int line, std::size_t& bytes) {
    bytes += size;
    total_ += size;
    if (bytes > kMaxLineBytes || total_ > kMaxUnrolledBytes) {
      throw ScriptError(line, bytes > kMaxLineBytes
                                  ? "the line grows too long"
                                  : "the script grows too long when its loops are unrolled");
    }
  }

  const Variables& defines_;
  Variables variables_;
  std::vector<ScriptLine> lines_;
  std::size_t total_ = 0;
  int statements_ = 0;
};

}  // namespace

std::vector<ScriptLine> read_script(std::string_view text, const Variables& defines) {
  if (text.size() > kMaxScriptBytes) {
    throw ScriptError(1, "the script is longer than " + std::to_string(kMaxScriptBytes) + " bytes");
  }
  LineReader reader(text);
  const std::vector<Statement> block = parse_block(reader, 0, 0);
  Unroller unroller(defines);
  unroller.run(block);
  return unroller.take();
}

bool is_variable_name(std::string_view text) noexcept {
  if (text.empty() || (text[0] >= '0' && text[0] <= '9')) {
    return false;
  }
  for (const char c : text) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (!letter && !(c >= '0' && c <= '9') && c != '_') {
      return false;
    }
  }
  return true;
}

}  // namespace haptic::cli
