//! What the page holds, what it keeps out, and the page as one file.

use super::tables::is_number;
use super::*;
use crate::finding::{EvaluationFact, Place, ReadFact};
use crate::report::table::FabricRow;

fn page() -> Page {
    let rows = vec![
        vec!["poplin <A> & \"B\"".into(), "0.0922 ± 0.0030".into(), "ok".into()],
        vec!["経 wool".into(), "−1.2 × 10⁻⁵".into()],
    ];
    let warning = ReadFact::InstrumentWarning { warning: "an <error>".into() };
    Page {
        title: "Results of kesf_data".into(),
        lead: "12 fabrics, 7 cases".into(),
        sections: vec![
            Section {
                heading: "Fabrics".into(),
                blocks: vec![
                    Block::Text("Means over the specimens.".into()),
                    Block::Table {
                        caption: "Parameters".into(),
                        header: vec!["fabric".into(), "B (gf·cm²/cm)".into(), "status".into()],
                        rows,
                        of_fabrics: false,
                    },
                    Block::Findings(vec![
                        Finding::new(warning).at(Place::at("a b.csv", 3, 1)),
                        Finding::new(EvaluationFact::NoArealDensity {}),
                    ]),
                ],
            },
            Section {
                heading: "poplin".into(),
                blocks: vec![
                    Block::Figures(vec![Figure {
                        caption: "bending".into(),
                        picture: "pop lin#1/経 b.png".into(),
                        ..Figure::default()
                    }]),
                    Block::Files(vec!["javascript:alert(1)".into(), "poplin/sheet.json".into()]),
                ],
            },
        ],
        data: PageData::default(),
        workbooks: None,
    }
}

#[test]
fn everything_shown_is_escaped_and_every_address_stays_in_the_folder() {
    let text = html(&page());
    assert_eq!(text, html(&page()));
    if let Some(folder) = std::env::var_os("KESF_GALLERY") {
        std::fs::write(std::path::Path::new(&folder).join("index.html"), &text).unwrap();
    }
    assert!(text.contains("poplin &lt;A&gt; &amp; &quot;B&quot;"));
    assert!(text.contains("<code>a b.csv:3:1</code> the instrument&#39;s program warned: an &lt;error&gt;"));
    assert!(text.contains("src=\"./pop%20lin%231/%E7%B5%8C%20b.png\""));
    assert!(text.contains("href=\"./javascript%3Aalert%281%29\""));
    // The one `http` is the attribute of the policy, the others are names of XML.
    let named = ["http-equiv", "http://www.w3.org/2000/svg"].map(|name| text.matches(name).count());
    assert_eq!(text.matches("http").count(), named.iter().sum::<usize>(), "no address outside the folder");
    assert_eq!(text.matches("<script").count(), 2, "the data and the script of the page");
}

/// A browser hashes what stands between the tags: one byte more and the page is dead.
#[test]
fn the_policy_knows_the_script_and_the_style_and_nothing_else() {
    let text = html(&page());
    let between =
        |from: &str, to: &str| text.split(from).nth(1).unwrap().split(to).next().unwrap().to_string();
    let policy = between("Content-Security-Policy\" content=\"", "\"");
    let script = text.rsplit("<script>").next().unwrap().split("</script>").next().unwrap();
    for (what, content) in [("script-src", script), ("style-src", &between("<style>", "</style>"))] {
        let hash = STANDARD.encode(Sha256::digest(content.as_bytes()));
        assert!(policy.contains(&format!("{what} 'sha256-{hash}';")), "{policy}");
    }
    assert!(policy.starts_with("default-src 'none';") && !policy.contains("unsafe"));
}

#[test]
fn data_cannot_end_their_element() {
    let name = "</script><script>alert(1)</script>";
    let row =
        FabricRow { fabric: name.into(), parameter: "T0".into(), mean: Some(5e-4), ..FabricRow::default() };
    let fabric = FabricValues { name: name.into(), about: name.into(), ..FabricValues::default() };
    let data = PageData::of_rows([fabric].into_iter(), [row].iter());
    let sections = vec![Section {
        heading: name.into(),
        blocks: vec![
            Block::Parameters,
            Block::Fabric { name: name.into(), about: name.into(), blocks: vec![Block::Curves(0)] },
        ],
    }];
    let text = html(&Page { title: name.into(), lead: name.into(), sections, data, workbooks: None });
    assert_eq!(text.matches("<script").count(), 2);
    assert_eq!(text.matches("</script").count(), 2);
    let json = text.split("id=\"data\">").nth(1).unwrap().split("</script>").next().unwrap();
    let back: serde_json::Value = serde_json::from_str(json).unwrap();
    assert_eq!(back["fabrics"][0]["name"], name);
}

#[test]
fn problems_of_a_code_have_one_cure_and_no_absolute_path() {
    let line = |place: &str| ProblemLine {
        fabric: Some("a b".into()),
        page: Some(String::new()),
        place: place.into(),
        message: "as in /home/ann/x/y.csv: <no>".into(),
    };
    let lines = vec![line("/home/ann/my data/poplin/fb2.csv:3:1"), line("kesf_data/poplin")];
    let group = ProblemGroup { code: "K003".into(), count: "1 of 2 fabrics".into(), lines };
    let sections = vec![Section { heading: "Problems".into(), blocks: vec![Block::Problems(vec![group])] }];
    let text = html(&Page { sections, ..Page::default() });
    let cure = &explain("K003").unwrap().cure;
    assert_eq!(text.matches(&prose(cure)).count(), 1);
    assert!(text.contains(
        "<a href=\"#fabric-a%20b\">a b</a> <code>poplin/fb2.csv:3:1</code> as in x/y.csv: &lt;no&gt;"
    ));
    assert!(!text.contains("/home"));
}

#[test]
fn one_of_two_units_is_shown() {
    let same = ["B warp", "B warp"].map(String::from);
    let both = ["0.05210", "5.109e-6"].map(String::from);
    let header = vec!["quantity".into(), "measured".into()];
    let block = Block::Units { caption: "Tests".into(), header, rows: vec![vec![same, both]] };
    let sections = vec![Section { heading: "Tests".into(), blocks: vec![block] }];
    let text = html(&Page { sections, ..Page::default() });
    let cells = "<td>B warp</td><td class=\"number\"><span class=\"kes\">0.05210</span><span class=\"si\">5.109e-6</span></td>";
    assert!(text.contains(cells));
}

#[test]
fn a_self_contained_page_has_its_pictures_and_no_addresses() {
    let mut asked = Vec::new();
    let picture = |name: &str| -> Result<Vec<u8>, ()> {
        asked.push(name.to_string());
        Ok(b"\x89PNG".to_vec())
    };
    let OneFile { page: text, left_out } = self_contained(&html(&page()), LIMIT, picture).unwrap().unwrap();
    assert_eq!(asked, ["pop lin#1/経 b.png"]);
    assert!(left_out.is_empty() && !text.contains("left-out"));
    // RFC 4648: the bytes 89 50 4E 47 are "iVBORw==".
    assert!(text.contains(
        "<figure><img src=\"data:image/png;base64,iVBORw==\" alt=\"bending\" data-kind=\"benchmark\" width=\"1800\" height=\"1350\" loading=\"lazy\"><figcaption>"
    ));
    assert!(text.contains("<li>poplin/sheet.json</li>"));
    assert!(!text.contains("=\"./"));
    assert!(text.contains("href=\"#s1\""), "links within the page stay");
    assert_eq!(self_contained(&html(&page()), LIMIT, |_| Err(7)), Err(7));
    assert_eq!(self_contained("<a href=\"./x", LIMIT, |_| Err(7)), Ok(None));
}

/// All pictures of a name or none, in their order, and what is not there is told where it would be and at the end.
#[test]
fn what_does_not_fit_is_left_out_by_kinds_and_told() {
    let figure = |picture: &str| Figure { caption: "c".into(), picture: picture.into(), ..Figure::default() };
    let names = ["parity.png", "a/big.png", "b/big.png", "a/small.png", "b/small.png"];
    let blocks = vec![Block::Figures(names.map(figure).to_vec())];
    let index = html(&Page { sections: vec![Section { heading: "x".into(), blocks }], ..Page::default() });
    let picture =
        |name: &str| -> Result<Vec<u8>, ()> { Ok(vec![0; if name.contains("big") { 900 } else { 300 }]) };
    // Base64 makes 4 bytes of 3: parity 400, big 2 x 1200, small 2 x 400; 2000 are kept for the note.
    let made = self_contained(&index, index.len() + 2000 + 1300, picture).unwrap().unwrap();
    assert_eq!(made.left_out, ["a/big.png", "b/big.png"]);
    assert_eq!(made.page.matches("data:image/png").count(), 3);
    let line = "<p class=\"absent\">Not in this file: big.png, big.png.</p>\n</div>";
    assert!(made.page.contains(line) && !made.page.contains("a/big.png"), "no frame of what is not there");
    assert_eq!(made.page.matches("<figcaption>").count(), 3);
    assert!(made.page.contains("2 pictures, big.png (2). They are in the folder of results"));
    let all = self_contained(&index, usize::MAX, picture).unwrap().unwrap();
    assert!(all.left_out.is_empty());
}

/// A page that is sent has drapes before benchmarks, and of what does not fit whole the first fabrics.
#[test]
fn what_is_worth_most_is_taken_first() {
    let figure = |(picture, kind): (&str, FigureKind)| Figure {
        picture: picture.into(),
        alt: "A \"drape\" data-kind=\"test\".".into(),
        kind,
        ..Figure::default()
    };
    let of_fabrics = ["a", "b", "c"].map(|fabric| {
        let (plate, drape) = (format!("{fabric}/plate.png"), format!("{fabric}/drape.png"));
        let figures = [(plate.as_str(), FigureKind::Plate), (drape.as_str(), FigureKind::Drape)].map(figure);
        Block::Figures(figures.to_vec())
    });
    let benchmark = Block::Figures(vec![figure(("square.png", FigureKind::Benchmark))]);
    let blocks = std::iter::once(benchmark).chain(of_fabrics).collect();
    let index = html(&Page { sections: vec![Section { heading: "x".into(), blocks }], ..Page::default() });
    let sent = |pictures: usize| {
        let limit = index.len() + 2000 + 400 * pictures;
        self_contained(&index, limit, |_| Ok::<_, ()>(vec![0; 300])).unwrap().unwrap().left_out
    };
    assert_eq!(sent(2), ["square.png", "a/plate.png", "b/plate.png", "c/plate.png", "c/drape.png"]);
    assert_eq!(sent(5), ["square.png", "c/plate.png"]);
    assert!(sent(7).is_empty());
}

/// Each value that is not to be relied on leads to what speaks against it.
#[test]
fn doubtful_values_have_their_causes() {
    let value = DoubtfulValue {
        fabric: "wool_a".into(),
        parameter: "B warp".into(),
        mean: ["1.900 gf·cm²/cm", "1.863e-4 N·m"].map(String::from),
        n: 3,
        status: "doubtful".into(),
        causes: vec!["K011".into()],
        page: String::new(),
    };
    let elsewhere = DoubtfulValue { page: "index.html".into(), ..value.clone() };
    let group = ProblemGroup { code: "K011".into(), count: "1 of 2 fabrics".into(), lines: Vec::new() };
    let blocks = vec![Block::Doubtful(vec![value, elsewhere]), Block::Problems(vec![group])];
    let text = html(&Page { sections: vec![Section { heading: "x".into(), blocks }], ..Page::default() });
    assert!(text.contains("<td><a href=\"#fabric-wool_a\">wool_<wbr>a</a></td><td>B warp</td>"));
    assert!(text.contains("<td>n 3</td><td class=\"doubtful\">doubtful</td><td><a href=\"#problem-K011\">K011</a> An implausible value. "));
    assert!(text.contains("href=\"./index.html#problem-K011\"") && text.contains("<li id=\"problem-K011\">"));
}

/// A table of the fabrics of other pages leads there, one of the page itself to their parts.
#[test]
fn fabrics_of_a_table_are_links() {
    let elsewhere = TableCell {
        text: "wool_a".into(),
        leads_to: Some(("fabrics-2.html".into(), "wool_a".into())),
        ..TableCell::default()
    };
    let rows = vec![vec![elsewhere], vec!["a b".into()], vec!["unknown".into()]];
    let table =
        Block::Table { caption: String::new(), header: vec!["fabric".into()], rows, of_fabrics: true };
    let more = Block::More { summary: "all <of> them".into(), blocks: vec![table] };
    let pages = Block::Pages(vec![("fabrics-1.html".into(), "a b… to c…".into())]);
    let fabrics = vec![FabricValues { name: "a b".into(), ..FabricValues::default() }];
    let data = PageData { fabrics, ..PageData::default() };
    let sections = vec![Section { heading: "x".into(), blocks: vec![more, pages] }];
    let text = html(&Page { sections, data, ..Page::default() });
    assert!(text.contains("<td><a href=\"./fabrics-2.html#fabric-wool_a\">wool_<wbr>a</a></td>"));
    assert!(text.contains("<td><a href=\"#fabric-a%20b\">a b</a></td>") && text.contains("<td>unknown</td>"));
    assert!(text.contains("<li><a href=\"./fabrics-1.html\">a b… to c…</a></li>"));
    assert!(text.contains("<details class=\"more\"><summary>all &lt;of&gt; them</summary>"));
}

/// Data of the page, which no policy for scripts forbids.
#[test]
fn workbooks_are_in_the_page() {
    let books = Workbooks { kes: b"PK".to_vec(), si: b"PKS".to_vec() };
    let text = html(&Page { workbooks: Some(books), ..page() });
    // RFC 4648.
    assert!(text.contains("id=\"workbooks\">{\"kes\":\"UEs=\",\"si\":\"UEtT\"}</script>"));
    assert!(!html(&page()).contains("id=\"workbooks\""));
}

/// What a browser shows is shown, and what it does not is a link.
#[test]
fn pictures_are_taken_by_their_kind() {
    let figure = |picture: &str| Figure { caption: "c".into(), picture: picture.into(), ..Figure::default() };
    let blocks = vec![Block::Figures(["a/b.svg", "a/b.pdf"].map(figure).to_vec())];
    let index = html(&Page { sections: vec![Section { heading: "x".into(), blocks }], ..Page::default() });
    assert!(index.contains("<img src=\"./a/b.svg\"") && index.contains("<a href=\"./a/b.pdf\">c (PDF)</a>"));
    let made = self_contained(&index, LIMIT, |_| Ok::<_, ()>(vec![0])).unwrap().unwrap();
    assert!(
        made.page.contains("<img src=\"data:image/svg+xml;base64,AA==\"") && !made.page.contains("=\"./")
    );
}

#[test]
fn columns_of_numbers_are_set_to_the_right_and_short_rows_are_filled() {
    let text = html(&page());
    assert!(text.contains("<td class=\"number\">0.0922 ± 0.0030</td><td>ok</td>"));
    assert!(text.contains("<td class=\"number\">−1.2 × 10⁻⁵</td><td></td></tr>"));
    for number in ["3", "12 %", "(1.2 ± 0.1) × 10⁻⁵", "5.2e-6"] {
        assert!(is_number(number), "{number}");
    }
    for word in ["", "ok", "3 mm", "–", "K003"] {
        assert!(!is_number(word), "{word}");
    }
}

#[test]
fn elements_are_closed_in_order() {
    let text = html(&page());
    let mut open = Vec::new();
    for tag in text.split('<').skip(1) {
        let name: String =
            tag.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '/' || *c == '!').collect();
        match name.strip_prefix('/') {
            Some(closed) => assert_eq!(open.pop().as_deref(), Some(closed)),
            // What looks like a tag in a script is none.
            None if open.last().is_some_and(|o| o == "script") => {}
            None if ["!DOCTYPE", "meta", "img", "br", "wbr"].contains(&name.as_str()) => {}
            None => open.push(name),
        }
    }
    assert!(open.is_empty(), "{open:?}");
}
