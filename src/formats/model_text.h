// The text of a model file, or what the file is instead.
#pragma once

#include <string>
#include <string_view>

namespace limn {

/// UTF-8 with line feeds. What has another encoding is held converted.
class ModelText {
public:
    /// `bytes` must outlive this. UTF-16 with a mark of its byte order, and lines that end in carriage returns alone,
    /// are converted. Throws Error (badData) where the bytes are no text of a model: it says what they are, if known.
    ModelText(std::string_view bytes, const std::string& file);
    ModelText(const ModelText&) = delete;
    ModelText& operator=(const ModelText&) = delete;

    std::string_view text() const { return isConverted_ ? converted_ : bytes_; }

private:
    std::string_view bytes_;
    std::string converted_;
    bool isConverted_ = false;
};

}  // namespace limn
