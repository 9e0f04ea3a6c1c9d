//! Takes the files of rerun's web viewer out of the crate that holds them, for `src/recording/web_viewer.rs`
//! to build in.

#[cfg(not(feature = "rerun"))]
fn main() {}

#[cfg(feature = "rerun")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    use std::path::PathBuf;
    use std::{env, fs};

    use re_web_viewer_server::WebViewerData;

    println!("cargo::rerun-if-changed=build.rs");
    let folder = PathBuf::from(env::var_os("OUT_DIR").ok_or("cargo gives no folder")?);
    let viewer = WebViewerData::load(None)?;
    let page = at_home(std::str::from_utf8(viewer.index_html())?)?;
    for (name, content) in [
        ("index.html", page.as_bytes()),
        ("favicon.ico", viewer.favicon()),
        ("sw.js", viewer.sw_js()),
        ("re_viewer.js", viewer.viewer_js()),
        ("re_viewer_bg.wasm", viewer.viewer_wasm()),
    ] {
        fs::write(folder.join(name), content)?;
    }
    Ok(())
}

/// The page without the fonts that it would load from elsewhere.
#[cfg(feature = "rerun")]
fn at_home(page: &str) -> Result<String, &'static str> {
    let begin = page.find("<link rel=\"preconnect\"").ok_or("the page has another head than it had")?;
    let end = begin + page[begin..].find("<title>").ok_or("the page has no title")?;
    Ok(format!("{}{}", &page[..begin], &page[end..]))
}
