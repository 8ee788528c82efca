//! A headless Chromium, which is controlled by the DevTools protocol.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::{Value, json};
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tungstenite::{Message, WebSocket};

/// Time-out of the wait for a condition.
const PATIENCE: Duration = Duration::from_secs(20);

/// A headless browser.
pub struct Browser {
    child: Child,
    socket: WebSocket<TcpStream>,
    calls: u64,
    loads: u32,
    _profile: tempfile::TempDir,
}

/// An open page of the browser.
pub struct Page(String);

impl Browser {
    /// Starts Debian's `chromium`.
    pub fn start() -> Self {
        let profile = tempfile::tempdir().unwrap();
        let mut child = Command::new("chromium")
            .args([
                "--headless=new",
                "--no-sandbox",
                "--disable-gpu",
                "--disable-dev-shm-usage",
                "--disable-extensions",
                "--disable-background-networking",
                "--disable-background-timer-throttling",
                "--disable-backgrounding-occluded-windows",
                "--disable-renderer-backgrounding",
                "--no-first-run",
                "--remote-debugging-port=0",
                "--window-size=1280,1280",
            ])
            .arg(format!("--user-data-dir={}", profile.path().display()))
            .arg("about:blank")
            .stdin(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap_or_else(|error| panic!("chromium: {error}; run `cargo xtask bootstrap`"));
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let url = lines
            .by_ref()
            .find_map(|line| {
                Some(
                    line.unwrap()
                        .strip_prefix("DevTools listening on ")?
                        .to_owned(),
                )
            })
            .expect("chromium has ended");
        // The messages are read, so that the browser does not block.
        std::thread::spawn(move || lines.for_each(drop));
        let host = url.split('/').nth(2).unwrap();
        let stream = TcpStream::connect(host).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        let (socket, _) = tungstenite::client(&url, stream).unwrap();
        Self {
            child,
            socket,
            calls: 0,
            loads: 0,
            _profile: profile,
        }
    }

    /// Calls a method of the protocol on a page or on the browser, and returns its result.
    pub fn call(&mut self, page: Option<&Page>, method: &str, parameters: Value) -> Value {
        self.calls += 1;
        let mut call = json!({ "id": self.calls, "method": method, "params": parameters });
        if let Some(Page(session)) = page {
            call["sessionId"] = json!(session);
        }
        self.socket.send(Message::text(call.to_string())).unwrap();
        loop {
            let mut found = self.read(&call.to_string());
            if found["id"] == self.calls {
                assert!(found["error"].is_null(), "{method}: {}", found["error"]);
                return found["result"].take();
            }
        }
    }

    /// Reads the next message of the browser, and counts the loaded pages. `wanted` names the
    /// awaited message in an error.
    fn read(&mut self, wanted: &str) -> Value {
        loop {
            let message = self.socket.read();
            if let Message::Text(text) = message.unwrap_or_else(|error| panic!("{wanted}: {error}"))
            {
                let found: Value = serde_json::from_str(&text).unwrap();
                self.loads += u32::from(found["method"] == "Page.loadEventFired");
                return found;
            }
        }
    }

    /// Opens a page at an address.
    pub fn open(&mut self, url: &str) -> Page {
        self.open_with(url, "")
    }

    /// Opens a page at an address, in a browser that a script has changed before the page's own scripts run.
    pub fn open_with(&mut self, url: &str, script: &str) -> Page {
        let target = self.call(None, "Target.createTarget", json!({ "url": "about:blank" }));
        let attach = json!({ "targetId": target["targetId"], "flatten": true });
        let session = self.call(None, "Target.attachToTarget", attach);
        let page = Page(session["sessionId"].as_str().unwrap().to_owned());
        self.call(Some(&page), "Page.enable", json!({}));
        let script = json!({ "source": script });
        self.call(Some(&page), "Page.addScriptToEvaluateOnNewDocument", script);
        let loads = self.loads;
        self.call(Some(&page), "Page.navigate", json!({ "url": url }));
        while self.loads == loads {
            self.read(url);
        }
        page
    }

    /// Evaluates an expression in a page.
    pub fn evaluate(&mut self, page: &Page, expression: &str) -> Value {
        let parameters =
            json!({ "expression": expression, "awaitPromise": true, "returnByValue": true });
        let mut found = self.call(Some(page), "Runtime.evaluate", parameters);
        assert!(
            found["exceptionDetails"].is_null(),
            "{expression}: {}",
            found["exceptionDetails"]
        );
        found["result"]["value"].take()
    }

    /// Waits until a condition is true in a page; fails after 20 s.
    pub fn wait(&mut self, page: &Page, condition: &str) {
        let look = format!(
            "new Promise((done) => {{ const look = () => ({condition}) ? done(true) : setTimeout(look, 5); look(); }})"
        );
        self.evaluate(page, &look);
    }

    /// Waits until the monitor of a live page shows a picture with more than `count` bright pixels.
    pub fn wait_for_light(&mut self, page: &Page, count: u32) {
        let lit = "(() => { const canvas = document.getElementById('monitor'); \
            const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height); \
            let lit = 0; for (let i = 0; i < data.length; i += 4) lit += data[i + 1] > 100; return lit; })()";
        self.wait(page, &format!("{lit} > {count}"));
    }

    /// Types a text into the focused element, and presses Enter.
    pub fn type_line(&mut self, page: &Page, text: &str) {
        self.call(Some(page), "Input.insertText", json!({ "text": text }));
        self.press(page, "Enter", "\r");
    }

    /// Presses and releases a key.
    pub fn press(&mut self, page: &Page, key: &str, text: &str) {
        for kind in ["keyDown", "keyUp"] {
            let event = json!({ "type": kind, "key": key, "code": key, "text": if kind == "keyDown" { text } else { "" },
                "windowsVirtualKeyCode": match key { "Enter" => 13, "Tab" => 9, "ArrowUp" => 38, _ => 0 } });
            self.call(Some(page), "Input.dispatchKeyEvent", event);
        }
    }

    /// Sends a mouse event of type `kind`, such as `mouseMoved`, at a position of the page in
    /// pixels.
    pub fn mouse(&mut self, page: &Page, kind: &str, [x, y]: [f64; 2]) {
        let buttons = u8::from(kind != "mouseReleased");
        let event = json!({ "type": kind, "x": x, "y": y, "button": "left", "buttons": buttons, "clickCount": 1 });
        self.call(Some(page), "Input.dispatchMouseEvent", event);
    }

    /// Drops files and folders at a position of the page.
    pub fn drop_paths(&mut self, page: &Page, [x, y]: [f64; 2], paths: &[impl AsRef<Path>]) {
        let paths: Vec<_> = paths.iter().map(AsRef::as_ref).collect();
        let data = json!({ "items": [], "files": paths, "dragOperationsMask": 1 });
        for kind in ["dragEnter", "dragOver", "drop"] {
            let event = json!({ "type": kind, "x": x, "y": y, "data": data });
            self.call(Some(page), "Input.dispatchDragEvent", event);
        }
    }

    /// Chooses files, or a folder, in an input of the page.
    pub fn choose_paths(&mut self, page: &Page, selector: &str, paths: &[impl AsRef<Path>]) {
        let expression = format!("document.querySelector({selector:?})");
        let found = self.call(
            Some(page),
            "Runtime.evaluate",
            json!({ "expression": expression }),
        );
        let paths: Vec<_> = paths.iter().map(AsRef::as_ref).collect();
        let chosen = json!({ "files": paths, "objectId": found["result"]["objectId"] });
        self.call(Some(page), "DOM.setFileInputFiles", chosen);
    }

    /// Returns a screenshot of the page as PNG.
    pub fn picture(&mut self, page: &Page) -> Vec<u8> {
        let picture = self.call(
            Some(page),
            "Page.captureScreenshot",
            json!({ "format": "png" }),
        );
        STANDARD.decode(picture["data"].as_str().unwrap()).unwrap()
    }

    /// Returns the position of an element's middle on the page.
    pub fn middle(&mut self, page: &Page, selector: &str) -> [f64; 2] {
        let place = self.evaluate(
            page,
            &format!(
                "(() => {{ const found = document.querySelector({selector:?}); found.scrollIntoView({{ block: 'center' }}); \
                 const box = found.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; }})()"
            ),
        );
        [0, 1].map(|axis| place[axis].as_f64().unwrap())
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        // An error means that the browser has already ended, which has made the test fail.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
