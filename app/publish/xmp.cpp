#include "app/publish/xmp.h"

#include <fmt/format.h>

#include "core/base/text/markup_text.h"

namespace dubsar::app {
namespace {

std::string in_every_language(const char* name, const std::string& text) {
  if (text.empty()) return {};
  return fmt::format("<dc:{0}><rdf:Alt><rdf:li xml:lang=\"x-default\">{1}</rdf:li></rdf:Alt></dc:{0}>\n", name,
                     markup_text(text));
}

}  // namespace

std::string xmp_packet(const Publication& p) {
  if (p.title.empty() && p.rights.empty() && p.institution.empty()) return {};
  std::string body = in_every_language("title", p.title) + in_every_language("rights", p.rights);
  if (!p.institution.empty())
    body += fmt::format("<dc:publisher><rdf:Bag><rdf:li>{}</rdf:li></rdf:Bag></dc:publisher>\n",
                        markup_text(p.institution));
  if (!p.made_by.empty()) body += fmt::format("<xmp:CreatorTool>{}</xmp:CreatorTool>\n", markup_text(p.made_by));
  return "<?xpacket begin=\"\xef\xbb\xbf\" id=\"W5M0MpCehiHzreSzNTczkc9d\"?>\n"
         "<x:xmpmeta xmlns:x=\"adobe:ns:meta/\"><rdf:RDF xmlns:rdf=\"http://www.w3.org/1999/02/22-rdf-syntax-ns#\">\n"
         "<rdf:Description rdf:about=\"\" xmlns:dc=\"http://purl.org/dc/elements/1.1/\" "
         "xmlns:xmp=\"http://ns.adobe.com/xap/1.0/\">\n" +
         body + "</rdf:Description></rdf:RDF></x:xmpmeta>\n<?xpacket end=\"w\"?>";
}

}  // namespace dubsar::app
